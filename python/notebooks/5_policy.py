# SPDX-License-Identifier: MIT OR Apache-2.0
# %% [markdown]
# # A policy that finds a hidden wall
#
# `hapticore/Wall-v0`: a wall lies somewhere left of the pad; only its force tells of it. The policy moves the finger by
#
#     dx = −v·max(0, 1 − force/f)      (mm in each millisecond)
#
# to the left, slower the more it feels, and the cross-entropy method finds v and f: of a generation of policies the best make the next one's mean and spread.

# %%
import os

import gymnasium
import numpy as np

import hapticore as hc

LONG = "HAPTICORE_LONG" in os.environ
GENERATIONS, POLICIES, BEST, STEPS = (10, 24, 6, 1000) if LONG else (4, 10, 3, 400)

env = gymnasium.make("hapticore/Wall-v0")
steps = 0


def episode(policy, wall_mm, length=STEPS):
    """Score of an episode: 0.01 for each step at 0.3 N; and whether the wall was found."""
    global steps
    observed, info = env.reset(options={"wall_mm": wall_mm})
    finger_mm, score = 10.0, 0.0
    for _ in range(length):
        speed, stop_n = policy
        finger_mm -= float(np.clip(speed * (1 - observed[3] / stop_n), 0.0, 0.3))
        finger_mm = max(finger_mm, -60.0)
        observed, reward, _, _, info = env.step(np.array([finger_mm / 60, 10 / 60], dtype=np.float32))
        score += reward
    steps += length
    return score, info["found"]


# %%
chance = np.random.default_rng(3)
first = np.array([0.2, 0.6])
mean, spread = np.log(first), np.array([0.7, 0.6])
for generation in range(GENERATIONS):
    wall_mm = chance.uniform(-40 if LONG else -12, 0)
    policies = mean + spread * chance.standard_normal((POLICIES, 2))
    scores = [episode(np.exp(policy), wall_mm)[0] for policy in policies]
    best = policies[np.argsort(scores)[-BEST:]]
    mean, spread = best.mean(axis=0), best.std(axis=0) + 0.05
    print(f"generation {generation}: best score {max(scores):.2f}, mean {np.mean(scores):.2f}")

trained = steps
policy = np.exp(mean)

# %% [markdown]
# Walls at places that it was not trained on:

# %%
places_mm = [-2.0, -11.0, -19.0, -27.0, -36.0]
trials = len(places_mm)
results = [episode(policy, place_mm, 1000) for place_mm in places_mm]
found = sum(result[1] for result in results)
score = float(np.mean([result[0] for result in results]))
print(f"v = {policy[0]:.3f} mm/ms, f = {policy[1]:.2f} N: found {found} of {trials} walls, mean score {score:.2f}")
print(f"trained on {trained} steps of 1 ms, hapticore {hc.__version__}")

# %% [markdown]
# The policy that training began with goes so fast that it slides through:

# %%
untrained = sum(episode(first, place_mm, 1000)[1] for place_mm in places_mm)
print(f"untrained: found {untrained} of {trials} walls")

shown = found == trials and untrained == 0
