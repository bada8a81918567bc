"""The navigator map: labelled vectors between neighbouring sectors (§7)."""


def navigator_map(sectors, rules):
    """One vector from each sector to the next, from right to left: from x, y, to x, y, label."""
    return [(a.x, a.y, b.x, b.y, label(a, b, rules)) for a, b in zip(sectors, sectors[1:])]


def label(a, b, rules):
    """The paper's rules, in their order."""
    if a.label == b.label:
        return a.label
    apart, labels = abs(a.radius - b.radius), (a.label, b.label)
    if "obstacle" in labels and not apart > rules["large"]:  # "not large"
        return "obstacle"
    if "visibility" in labels and apart <= rules["small"]:  # "small"
        return "visibility"
    return "unknown"
