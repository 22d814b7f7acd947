#!/usr/bin/env python3
"""Calibrates the weights of slam/localizer_evidence.cpp on CSV files that slam_localize --dump wrote.

Platt scaling: the weights' sum is scaled and shifted so that the logistic of it is the frequency
with which such frames were right. Frames whose dead reckoning is as good as certain are used.
Prints the new weights, and the curve on the same files; the curve that counts is that of
slam_localize in other worlds. Usage: fit_confidence.py A.csv [B.csv ...]   (standard library only)
"""
import math
import pathlib
import re
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[3] / "slam" / "localizer_evidence.cpp"


def present_weights():
    text = re.search(r"kWeights = \{([^}]*)\}", SOURCE.read_text()).group(1)
    return [float(v) for v in text.split(",")]


def read(files, weights):
    """(sum of the weighted evidence, right or not) of every frame."""
    rows = []
    for name in files:
        for line in open(name):
            right, sure, *x = (float(v) for v in line.split(","))
            if sure > 0.99:
                rows.append((sum(a * b for a, b in zip(weights, x)), right))
    return rows


def sigmoid(z):
    return 1.0 / (1.0 + math.exp(-max(-40.0, min(40.0, z))))


def platt(rows):
    """Newton's method for the two unknowns."""
    scale, shift = 1.0, 0.0
    for _ in range(50):
        g0 = g1 = h01 = 0.0
        h00 = h11 = 1e-3
        for z, right in rows:
            p = sigmoid(scale * z + shift)
            g0 += (right - p) * z
            g1 += right - p
            h00 += p * (1 - p) * z * z
            h01 += p * (1 - p) * z
            h11 += p * (1 - p)
        d = h00 * h11 - h01 * h01
        scale += (g0 * h11 - g1 * h01) / d
        shift += (g1 * h00 - g0 * h01) / d
    return scale, shift


def main():
    weights = present_weights()
    rows = read(sys.argv[1:], weights)
    scale, shift = platt(rows)
    print(f"{len(rows)} frames, {sum(1 - r for _, r in rows):.0f} wrong; "
          f"scale {scale:.3f}, shift {shift:.3f}")
    print("weights:", ", ".join(f"{scale * w + (shift if i == 0 else 0):.2f}"
                                for i, w in enumerate(weights)))
    edges = [0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.99, 0.995, 1.0]
    for low, high in zip(edges, edges[1:]):
        said = [(sigmoid(scale * z + shift), r) for z, r in rows]
        inside = [(p, r) for p, r in said if low <= p < high or p == high == 1.0]
        if inside:
            n = len(inside)
            print(f"  said {sum(p for p, _ in inside) / n:.3f}  right "
                  f"{sum(r for _, r in inside) / n:.3f}  ({n} frames)")


if __name__ == "__main__":
    main()
