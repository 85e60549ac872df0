"""A confidence interval for the median of a noisy quantity."""

import math
from dataclasses import dataclass

CONFIDENCE = 0.99
FEWEST = 8  # with fewer samples even their whole range contains the median with less confidence


@dataclass(frozen=True)
class Interval:
    """Contains the median of the sampled quantity with CONFIDENCE, whatever its distribution."""

    low: float
    median: float
    high: float

    @classmethod
    def of(cls, samples):
        """From at least one sample; of fewer than FEWEST it reaches from 0 to infinity.

        A sample is below the median as often as above: how many of n are is binomial, and so is the
        chance that the median lies outside the range of samples without the k least and k greatest.
        """
        samples = sorted(samples)
        count = len(samples)
        half = count // 2
        median = samples[half] if count % 2 else 0.5 * (samples[half - 1] + samples[half])
        outside, left_out = 0.0, -1
        while True:
            outside += 2.0 * math.comb(count, left_out + 1) / 2**count
            if outside > 1.0 - CONFIDENCE:
                break
            left_out += 1
        if left_out < 0:
            return cls(0.0, median, math.inf)
        return cls(samples[left_out], median, samples[count - 1 - left_out])

    @property
    def spread(self):
        """Its half width as a fraction of the median."""
        return 0.5 * (self.high - self.low) / self.median

    def __str__(self):
        return f"{self.median:.4g} ({self.low:.4g} to {self.high:.4g})"
