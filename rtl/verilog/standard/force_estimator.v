// force_estimator: hapticore_model::blocks::force::Force
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module force_estimator (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  All others are there, and hold.
    input wire [23:0] capacitance, // u24.13  The capacitance.
    input wire [21:0] mean_square, // u22.22  The mean square of the haptic voltage.
    input wire [17:0] gain, // u18.34  Newtons per square picofarad at full mean square.
    output reg done, // u1.0  Set for one clock when the force is there.
    output reg [19:0] haptic_force, // u20.17  The haptic force.
    output reg saturated // u1.0  Whether a word is held at a rail.
);

    reg [2:0] step; // u3.0  0 idle, 1 load, 2 square, 3 weigh, 4 energy, 5 scale, 6 force
    reg [23:0] left; // u24.0
    reg [23:0] right; // u24.0
    reg [47:0] product; // u48.0

    wire step_is_idle = step == 3'd0; // u1.0
    wire [25:0] fit_18 = {1'b0, product[47:23]} + {25'd0, product[22] & (product[23] | (|product[21:0]))}; // u26.3
    wire [23:0] fit_19 = (|fit_18[25:24]) ? {24{1'b1}} : fit_18[23:0]; // u24.3
    wire [45:0] fit_22 = product[45:0]; // u46.0
    wire [24:0] fit_24 = {1'b0, fit_22[45:22]} + {24'd0, fit_22[21] & (fit_22[22] | (|fit_22[20:0]))}; // u25.3
    wire [23:0] fit_25 = (|fit_24[24]) ? {24{1'b1}} : fit_24[23:0]; // u24.3
    wire [41:0] fit_28 = product[41:0]; // u42.0
    wire [22:0] fit_30 = {1'b0, fit_28[41:20]} + {22'd0, fit_28[19] & (fit_28[20] | (|fit_28[18:0]))}; // u23.17
    wire [19:0] fit_31 = (|fit_30[22:20]) ? {20{1'b1}} : fit_30[19:0]; // u20.17
    wire step_is_weigh = step == 3'd3; // u1.0
    wire bit_45 = (step_is_weigh & (~({2'd0, fit_19} == fit_18))) | ((step == 3'd5) & (~({1'd0, fit_25} == fit_24))); // u1.0
    wire step_is_7 = step == 3'd7; // u1.0
    wire [3:0] choice_51 = step_is_7 ? 4'd0 : ({1'd0, step} + 4'd1); // u4.0
    wire step_is_load = step == 3'd1; // u1.0
    wire [47:0] product_57 = left * right; // u48.0

    always @(posedge clock) begin
        if (reset) begin
            step <= 3'd0;
            left <= 24'd0;
            right <= 24'd0;
            product <= 48'd0;
            haptic_force <= 20'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                step <= 3'd1;
                saturated <= 1'd0;
                done <= 1'd0;
            end else if (step_is_idle) begin
                done <= 1'd0;
            end else begin
                step <= choice_51[2:0];
                product <= product_57;
                saturated <= saturated | (bit_45 | (step_is_7 & (~({3'd0, fit_31} == fit_30))));
                done <= step_is_7;
                if (step_is_7) begin
                    haptic_force <= fit_31;
                end
                if (step_is_load) begin
                    left <= capacitance;
                    right <= capacitance;
                end else if (step_is_weigh) begin
                    left <= fit_19;
                    right <= {2'd0, mean_square};
                end else begin
                    left <= fit_25;
                    right <= {6'd0, gain};
                end
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, choice_51[3]};

endmodule

`default_nettype wire
