# SPDX-License-Identifier: MIT OR Apache-2.0
# %% [markdown]
# # A recording of your own through the core
#
# `Core.slots` takes ADC codes as an array, wherever they come from. Here a simulated display stands for the recorder: four pads
# in turn, a window of samples of eight channels for each slot.

# %%
import numpy as np

import hapticore as hc

display = hc.Display("hockey")
frames, windows = [], []
for _ in range(200):
    frames.append(display.step())
    windows.append(display.codes())
np.savez("recording.npz", codes=np.array(windows), pads=[int(of["pad"][0]) for of in frames])

# %% [markdown]
# The recording, as from a file. The core has the calibration of the device that was recorded: here that of the scene;
# `hc.Core(calibration="mine.toml")` takes that of a device on your desk (`hc.calibrate`).

# %%
recording = np.load("recording.npz")
core = hc.Core("hockey")
print(core, "· codes", recording["codes"].shape, recording["codes"].dtype)
measured = core.slots(recording["pads"], recording["codes"])

# %%
true_mm = np.array([[of["true_x_mm"][0], of["true_y_mm"][0]] for of in frames])
error_mm = np.hypot(measured["x_mm"] - true_mm[:, 0], measured["y_mm"] - true_mm[:, 1])
print(f"position error: {np.sqrt((error_mm**2).mean()):.2f} mm rms, {error_mm.max():.2f} mm at most")

# %% [markdown]
# A gain of 1 % too much in one channel moves every position:

# %%
spoilt = recording["codes"].copy()
spoilt[:, :, 0] = np.clip(np.rint(spoilt[:, :, 0] * 1.01), *core.codes)
moved = hc.Core("hockey").slots(recording["pads"], spoilt)
moved_mm = np.hypot(moved["x_mm"] - measured["x_mm"], moved["y_mm"] - measured["y_mm"])
print(f"moved by {np.median(moved_mm):.2f} mm (median)")

shown = bool(np.sqrt((error_mm**2).mean()) < 1.0 and np.median(moved_mm) > 0.1)
