"""How large random effects are: standard deviations under which the data are most likely.

Effects u come in groups, those of a group with one standard deviation, and move white data y = H u + noise. The
marginal likelihood has its maximum where each group's squares are what its effects are known to be (fixed point of
MacKay, Neural Computation 4, 1992):

  sigma_g^2 = sum over g of E(u | y)^2 / sum over g of (1 - var(u | y) / sigma_g^2)
"""

from __future__ import annotations

import numpy as np

from sms.arrays import Array, Index


def most_likely(
    products: Array, score: Array, group: Index, start: Array, least: Array, iterations: int
) -> Array:
    """(groups,) standard deviations, from `start` (groups,) and never below `least` (groups,).

    products (sets, k, k): H'H, of sets of data that share nothing but the groups. score (sets, k): H'y. group (k,): of
    each effect. Some tens of iterations settle within some percent.
    """
    groups, sigma = len(start), start
    for _ in range(iterations):
        d = sigma[group]
        inner = np.eye(len(d)) + d[:, None] * products * d
        covariance = np.linalg.inv(inner)  # of the effects, in units of sigma
        mean = np.einsum("wij,wj->wi", covariance, d * score)
        told = (1.0 - np.einsum("wii->wi", covariance)).sum(axis=0)
        squares = np.bincount(group, (mean**2).sum(axis=0), groups)
        known = np.maximum(np.bincount(group, told, groups), 1e-12)
        sigma = np.maximum(sigma * np.sqrt(squares / known), least)
    return np.asarray(sigma)
