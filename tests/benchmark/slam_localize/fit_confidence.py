#!/usr/bin/env python3
"""Fits the weights of slam/localizer_evidence.cpp to CSV files that slam_localize --dump wrote.

Logistic regression (Newton) with a small ridge, on frames whose dead reckoning is as
good as certain; right and wrong frames are taken as they come, so that the result is a chance.
Usage: fit_confidence.py A.csv [B.csv ...]   (standard library only)
"""
import math
import sys

NAMES = ["constant", "log inliers", "matched share", "depth share", "scan share", "log frames",
         "recognitions", "rival", "shape margin", "log scan points", "surface share"]


def read(files):
    rows = []
    for name in files:
        for line in open(name):
            values = [float(v) for v in line.split(",")]
            if values[1] > 0.99:
                rows.append((values[0], values[2:]))
    return rows


def sigmoid(z):
    return 1.0 / (1.0 + math.exp(-max(-40.0, min(40.0, z))))


def fit(rows, ridge=1e-3):
    """Newton's method: eight weights, a few thousand rows."""
    n = len(rows[0][1])
    w = [0.0] * n
    for _ in range(30):
        gradient = [-ridge * len(rows) * v for v in w]
        hessian = [[(ridge * len(rows) if i == j else 0.0) for j in range(n)] for i in range(n)]
        for y, x in rows:
            p = sigmoid(sum(a * b for a, b in zip(w, x)))
            for i in range(n):
                gradient[i] += (y - p) * x[i]
                for j in range(n):
                    hessian[i][j] += p * (1 - p) * x[i] * x[j]
        step = solve(hessian, gradient)
        w = [a + b for a, b in zip(w, step)]
        if max(abs(s) for s in step) < 1e-6:
            break
    return w


def solve(a, b):
    n = len(b)
    m = [row[:] + [v] for row, v in zip(a, b)]
    for i in range(n):
        k = max(range(i, n), key=lambda r: abs(m[r][i]))
        m[i], m[k] = m[k], m[i]
        for r in range(i + 1, n):
            f = m[r][i] / m[i][i]
            for c in range(i, n + 1):
                m[r][c] -= f * m[i][c]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (m[i][n] - sum(m[i][j] * x[j] for j in range(i + 1, n))) / m[i][i]
    return x


def main():
    rows = read(sys.argv[1:])
    right = sum(y for y, _ in rows)
    print(f"{len(rows)} frames, {len(rows) - right:.0f} wrong")
    w = fit(rows)
    for name, value in zip(NAMES, w):
        print(f"  {name:14s} {value:8.3f}")
    loss = -sum(math.log(max(1e-12, p if y else 1 - p)) for y, p in
                ((y, sigmoid(sum(a * b for a, b in zip(w, x)))) for y, x in rows)) / len(rows)
    print(f"mean log loss {loss:.4f}")


if __name__ == "__main__":
    main()
