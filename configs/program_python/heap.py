"""A heap of grains in two dimensions, by toppling: grains fall on the middle of a plate, and where a step between two
columns is steeper than friction holds, its upper grain rolls down. Answers scene `program` line by line."""
import json
import math
import random
import sys


def heap(friction, scatter, grains, draw):
    half = 60
    height = [0] * (2 * half + 1)
    # The step that still holds differs from place to place.
    holds = [max(1.0, 10 * friction * (1 + scatter * draw.uniform(-1, 1))) for _ in height]
    for _ in range(grains):
        at = half
        height[at] += 1
        while True:
            left = height[at] - height[at - 1] if at > 0 else height[at]
            right = height[at] - height[at + 1] if at < 2 * half else height[at]
            step, to = (left, at - 1) if left > right or (left == right and draw.random() < 0.5) else (right, at + 1)
            if step <= holds[at]:
                break
            height[at] -= 1
            if not 0 <= to <= 2 * half:
                break  # off the plate
            height[to] += 1
            at = to
    return height


for line in sys.stdin:
    asked = json.loads(line)
    x = asked["inputs"]
    columns = heap(x["friction"], x["scatter"], int(x["grains"]), random.Random(asked["seed"]))
    base = sum(1 for h in columns if h > 0)
    angle = math.degrees(math.atan(max(columns) / 10 / (base / 2)))
    reply = {"angle": angle, "height": max(columns) / 10,
             "outline": [[k - len(columns) // 2, h / 10] for k, h in enumerate(columns)]}
    print(json.dumps({"case": asked["case"], "observables": reply}), flush=True)
