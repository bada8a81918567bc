"""Other programs that answer rays, asked the same questions as one's own: who is right, and where.

Each peer is a small adapter of one shape (:class:`Peer`). ``pip install raypencil[peers]`` brings those that pip can install;
``raypencil-peers`` is the command.

```python
from raypencil import peers

one = peers.peer("embree")
question = peers.asked(one, mesh, rays)          # rounded to what it reads
counts, judgement = peers.judged(one, question, one.first(question.mesh, question.rays))
```
"""

from ._known import LEFT_OUT, every_peer, peer
from ._peer import Hits, Peer, Unavailable
from ._question import Counts, Question, asked, judged

__all__ = ["LEFT_OUT", "Counts", "Hits", "Peer", "Question", "Unavailable", "asked", "every_peer", "judged", "peer"]
