"""Searches the ring of `ring.py` under the paper's VPN, flies what it finds, and flies around the tower."""

from ring import Ring
from tower import Tower

import skein_uav as skein

found = skein.search(
    Ring(),
    vary={"ring_m": (5, 12), "pursuer_mps": (5, 9)},
    objective="off-ring",
    candidates=200,
    link="vpn",
    out="searches/ring",
)
print(found.result.to_string(index=False))

flights = skein.fly(Ring(), loop=["stream", "predictive"], link="vpn", out="flights/ring")
print(next(iter(flights.tables.values())).to_string(index=False))

tower = skein.fly(Tower(), loop="predictive", link="vpn", out="flights/tower")
print(next(iter(tower.tables.values())).to_string(index=False))
