# SPDX-License-Identifier: MIT OR Apache-2.0
# %% [markdown]
# # What a bit costs
#
# The same display with ADCs of different resolution: the position's noise and the force's error.

# %%
import numpy as np

import hapticore as hc

errors_mm = {}
for bits in (8, 10, 12, 14, 16):
    settings = {"sensor.quantisation_bits": bits, "sensor.noise_ppm_rms": 0, "duration_s": 0.4}
    frames = hc.simulate("hockey", settings).frames
    # Against an ideal ADC, so that what other effects do is left out.
    ideal = hc.simulate("hockey", {**settings, "sensor.quantisation_bits": 18}).frames
    off_mm = np.hypot(frames["x_mm"] - ideal["x_mm"], frames["y_mm"] - ideal["y_mm"])
    off_n = np.abs(frames["force_n"] - ideal["force_n"])
    errors_mm[bits] = float(np.sqrt((off_mm**2).mean()))
    print(f"{bits} bits: position {errors_mm[bits]:.4f} mm rms, force {off_n.max():.5f} N at most")

# %% [markdown]
# A bit less doubles the ADC's steps; the core averages a thousand samples, so that even 10 bits resolve a fraction of a millimetre.

# %%
ratio = (errors_mm[8] / errors_mm[14]) ** (1 / 6)
print(f"from one bit to the next the error falls by a factor of {ratio:.2f}")

shown = bool(1.4 < ratio < 3.0)
