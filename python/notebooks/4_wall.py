# SPDX-License-Identifier: MIT OR Apache-2.0
# %% [markdown]
# # A wall and a finger
#
# The controller makes a wall of 0.5 N/mm left of x = 0. A finger on a spring of 300 N/m leads the pad into it, step by step.

# %%
import hapticore as hc

display = hc.Display("wall-2d")
frame = len(display.parts_mm)  # slots until each part of the pad has been measured
per_s = round(1 / (frame * display.slot_s))

# %% [markdown]
# In free air first: the scene's own finger goes to and fro for 0.6 s, from which the core learns what no push reads.

# %%
display.step(round(0.6 / display.slot_s))
display.wall(x_mm=0.0, y_mm=-200.0)

# %%
forces_n = []
for to_mm in (4.0, 0.0, -2.0, -4.0, -6.0):
    display.lead(0, to_mm, 10.0, within_s=0.1)
    rows = display.step(round(0.2 / display.slot_s))
    last = {name: rows[name][-frame * 20 :] for name in ("x_mm", "force_n", "true_force_n", "true_hand_x_n")}
    depth_mm = max(0.0, -last["x_mm"].mean())
    forces_n.append(float(last["true_force_n"].mean()))
    print(
        f"finger at {to_mm:5.1f} mm: pad {depth_mm:.2f} mm deep, force {last['force_n'].mean():.3f} N measured, "
        f"{forces_n[-1]:.3f} N true, hand {last['true_hand_x_n'].mean():.2f} N"
    )

# %% [markdown]
# Out again: the wall lets go as soon as the finger pulls.

# %%
display.lead(0, 6.0, 10.0, within_s=0.1)
rows = display.step(round(0.3 / display.slot_s))
out_n = float(rows["true_force_n"][-frame * 20 :].mean())
print(f"outside: {out_n:.3f} N")

shown = bool(forces_n[0] < 0.01 and forces_n[-1] > 0.3 and out_n < 0.01)
