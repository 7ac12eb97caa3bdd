// force_estimator: hapticore_model::blocks::force::Force
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module force_estimator (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  All others are there, and hold.
    input wire [14:0] capacitance, // u15.5  The capacitance.
    input wire [14:0] mean_square, // u15.15  The mean square of the haptic voltage.
    input wire [14:0] gain, // u15.31  Newtons per square picofarad at full mean square.
    output reg done, // u1.0  Set for one clock when the force is there.
    output reg [14:0] haptic_force, // u15.12  The haptic force.
    output reg saturated // u1.0  Whether a word is held at a rail.
);

    reg [2:0] step; // u3.0  0 idle, 1 load, 2 square, 3 weigh, 4 energy, 5 scale, 6 force
    reg [14:0] left; // u15.0
    reg [14:0] right; // u15.0
    reg [29:0] product; // u30.0

    wire step_is_idle = step == 3'd0; // u1.0
    wire [15:0] fit_18 = {1'b0, product[29:15]} + {15'd0, product[14] & (product[15] | (|product[13:0]))}; // u16.-5
    wire [14:0] fit_19 = (|fit_18[15]) ? {15{1'b1}} : fit_18[14:0]; // u15.-5
    wire bit_21 = ~({1'd0, fit_19} == fit_18); // u1.0
    wire [16:0] fit_23 = {1'b0, product[29:14]} + {16'd0, product[13] & (product[14] | (|product[12:0]))}; // u17.12
    wire [14:0] fit_24 = (|fit_23[16:15]) ? {15{1'b1}} : fit_23[14:0]; // u15.12
    wire step_is_weigh = step == 3'd3; // u1.0
    wire step_is_7 = step == 3'd7; // u1.0
    wire bit_42 = ((step_is_weigh & bit_21) | ((step == 3'd5) & bit_21)) | (step_is_7 & (~({2'd0, fit_24} == fit_23))); // u1.0
    wire [3:0] choice_44 = step_is_7 ? 4'd0 : ({1'd0, step} + 4'd1); // u4.0
    wire step_is_load = step == 3'd1; // u1.0
    wire [29:0] product_50 = left * right; // u30.0

    always @(posedge clock) begin
        if (reset) begin
            step <= 3'd0;
            left <= 15'd0;
            right <= 15'd0;
            product <= 30'd0;
            haptic_force <= 15'd0;
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
                step <= choice_44[2:0];
                product <= product_50;
                saturated <= saturated | bit_42;
                done <= step_is_7;
                if (step_is_7) begin
                    haptic_force <= fit_24;
                end
                if (step_is_load) begin
                    left <= capacitance;
                    right <= capacitance;
                end else if (step_is_weigh) begin
                    left <= fit_19;
                    right <= mean_square;
                end else begin
                    left <= fit_19;
                    right <= gain;
                end
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, choice_44[3]};

endmodule

`default_nettype wire
