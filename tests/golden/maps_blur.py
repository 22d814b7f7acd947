#!/usr/bin/python3
"""Prints the expected values of maps_blur_test.cpp: SciPy's blur of small integer grids.

Regenerate with: /usr/bin/python3 tests/golden/maps_blur.py > tests/golden/maps_blur.txt
(Debian's python3-scipy). Each case: "case WIDTH HEIGHT SIGMA", the input rows, the blurred rows.
"""
import numpy as np
from scipy.ndimage import gaussian_filter

rng = np.random.default_rng(7)
for width, height, density in ((24, 18, 0.04), (70, 9, 0.03), (5, 31, 0.2), (1, 1, 1.0), (3, 2, 0.4)):
    image = (rng.random((height, width)) < density).astype(np.int64)
    for sigma in (0.0, 0.7, 1.0, 2.0, 3.0, 4.0, 6.5):
        print("case", width, height, sigma)
        for row in image:
            print("".join("#" if v else "." for v in row))
        for row in gaussian_filter(image * 100, sigma=sigma):
            print(" ".join(str(v) for v in row))
