"""How large random effects are: standard deviations under which the data are most likely.

Effects u come in groups, those of a group with one standard deviation, and move white data y = H u + noise. The
marginal likelihood has its maximum where each group's squares are what its effects are known to be (fixed point of
MacKay, Neural Computation 4, 1992):

  sigma_g^2 = sum over g of E(u | y)^2 / sum over g of (1 - var(u | y) / sigma_g^2)

One set of data may need effects far larger than all others do, as a window in which a piston hangs on a stop; under
one normal distribution it alone would say how large they are everywhere. So those of a set are normal with a deviation
of their own, v^(1/2) sigma, with v of an inverse gamma distribution: together, Student's t with a few degrees of
freedom (Pinheiro, Liu and Wu, J. Comput. Graph. Stat. 10, 2001; Lange, Little and Taylor, J. Am. Stat. Assoc. 84,
1989, for the four).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sms.arrays import Array, Index

DEGREES = 4.0
"""Of freedom of Student's t. Convention: Lange, Little and Taylor's."""


def most_likely(
    products: Array,
    score: Array,
    group: Index,
    start: Array,
    least: Array,
    iterations: int,
    alike: bool = False,
    known: NDArray[np.bool_] | bool = False,
) -> tuple[Array, Array]:
    """(groups,) standard deviations, from `start` (groups,) and never below `least` (groups,); and (sets, groups), by
    which factor those of each set are larger. known (groups,): of which that is `start`, in all sets.

    products (sets, k, k): H'H, of sets of data that share nothing but the groups. score (sets, k): H'y. group (k,): of
    each effect. alike: all sets have one standard deviation. Some ten iterations settle within some percent.
    """
    groups, sigma = len(start), start
    larger = np.ones((len(products), groups))  # v of each set
    member = np.equal.outer(group, np.arange(groups)).astype(np.float64)
    for _ in range(iterations):
        d = sigma[group] * np.sqrt(larger)[:, group]
        inner = np.eye(len(group)) + d[:, :, None] * products * d[:, None, :]
        covariance = np.linalg.inv(inner)  # of the effects, in units of their deviations
        mean = np.einsum("wij,wj->wi", covariance, d * score)
        told = (1.0 - np.einsum("wii->wi", covariance)) @ member
        squares = mean**2 @ member
        sigma = sigma * np.sqrt(squares.sum(axis=0) / np.maximum(told.sum(axis=0), 1e-12))
        if not alike:
            larger = np.where(known, 1.0, (DEGREES + larger * squares) / (DEGREES + told))
            common = np.mean(1.0 / larger, axis=0)  # 1 where it ends
            larger, sigma = larger * common, sigma / np.sqrt(common)
        sigma = np.where(known, start, np.maximum(sigma, least))
    return np.asarray(sigma), np.sqrt(larger)
