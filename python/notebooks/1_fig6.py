# SPDX-License-Identifier: MIT OR Apache-2.0
# %% [markdown]
# # Figure 6: haptic force over voltage at three loads
#
# The paper's friction calibration, simulated, through the fixed-point core.

# %%
import hapticore as hc

run = hc.simulate("fig6")
for load_g in (20, 50, 100):
    at = run.frames.where(true_load_g=load_g, set_haptic_v_rms=300)
    print(f"{load_g} g, 300 V: {at['force_n'].mean():.4f} N, true {at['true_force_n'].mean():.4f} N")

# %% [markdown]
# What the scene claims, and what was measured:

# %%
for criterion in run.criteria:
    print(f"{criterion['measured']:.4f} {criterion['unit']} (limit {criterion['limit']}): {criterion['name']}")

shown = run.passed
