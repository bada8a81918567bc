"""Confidence intervals by the bootstrap over grounds: a ground is drawn with all its sectors, since these see the same stones."""

DRAWS = 4000
LEVEL = 0.95


def mixed(counter):
    """64 random bits of a counter (SplitMix64), so that a draw depends on its number alone."""
    mask = (1 << 64) - 1
    z = (counter + 1) * 0x9E3779B97F4A7C15 & mask
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & mask
    z = (z ^ z >> 27) * 0x94D049BB133111EB & mask
    return z ^ z >> 31


def interval(grounds, statistic):
    """The statistic of these grounds, and the interval that holds `LEVEL` of those of drawn grounds.

    `statistic` takes a list of grounds, and gives a number, or None where it has none (no obstacle on any drawn ground).
    With fewer than two grounds there is no interval.
    """
    value = statistic(grounds)
    if value is None or len(grounds) < 2:
        return value, None
    drawn = []
    for draw in range(DRAWS):
        places = (mixed(draw << 20 | place) % len(grounds) for place in range(len(grounds)))
        drawn.append(statistic([grounds[place] for place in places]))
    drawn = sorted(one for one in drawn if one is not None)
    cut = int(len(drawn) * (1 - LEVEL) / 2)
    return value, (drawn[cut], drawn[-1 - cut])
