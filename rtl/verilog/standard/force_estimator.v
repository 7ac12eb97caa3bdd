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

    reg [3:0] step; // u4.0  0 idle, 1 load, 2 square, 3 narrow_square, 4 weigh, 5 energy, 6 narrow_energy, 7 scale, 8 gain_product, 9 finish
    reg waited; // u1.0
    reg [23:0] left; // u24.0
    reg [23:0] right; // u24.0
    reg [23:0] factor; // u24.3
    wire [47:0] multiplier_product; // u48.0

    wire step_is_idle = step == 4'd0; // u1.0
    wire [25:0] fit_20 = {1'b0, multiplier_product[47:23]} + {25'd0, multiplier_product[22] & (multiplier_product[23] | (|multiplier_product[21:0]))}; // u26.3
    wire [45:0] fit_25 = multiplier_product[45:0]; // u46.0
    wire [24:0] fit_27 = {1'b0, fit_25[45:22]} + {24'd0, fit_25[21] & (fit_25[22] | (|fit_25[20:0]))}; // u25.3
    wire [41:0] fit_32 = multiplier_product[41:0]; // u42.0
    wire [22:0] fit_34 = {1'b0, fit_32[41:20]} + {22'd0, fit_32[19] & (fit_32[20] | (|fit_32[18:0]))}; // u23.17
    wire step_is_narrow_square = step == 4'd3; // u1.0
    wire step_is_narrow_energy = step == 4'd6; // u1.0
    wire bit_49 = (step_is_narrow_square & (~(fit_20[25:24] == 2'd0))) | (step_is_narrow_energy & (~(fit_27[24] == 1'd0))); // u1.0
    wire step_is_finish = step == 4'd9; // u1.0
    wire [4:0] choice_55 = step_is_finish ? 5'd0 : ({1'd0, step} + 5'd1); // u5.0
    wire step_is_load = step == 4'd1; // u1.0

    multiplier_4 u_multiplier (
        .clock(clock),
        .reset(reset),
        .enable(~step_is_idle),
        .left(left),
        .right(right),
        .product(multiplier_product)
    );

    always @(posedge clock) begin
        if (reset) begin
            step <= 4'd0;
            waited <= 1'd0;
            left <= 24'd0;
            right <= 24'd0;
            factor <= 24'd0;
            haptic_force <= 20'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                step <= 4'd1;
                waited <= 1'd0;
                saturated <= 1'd0;
                done <= 1'd0;
            end else if (step_is_idle) begin
                done <= 1'd0;
            end else if (waited) begin
                step <= choice_55[3:0];
                waited <= 1'd0;
                saturated <= saturated | (bit_49 | (step_is_finish & (~(fit_34[22:20] == 3'd0))));
                done <= step_is_finish;
                if (step_is_finish) begin
                    haptic_force <= (|fit_34[22:20]) ? {20{1'b1}} : fit_34[19:0];
                end
                if (step_is_narrow_square | step_is_narrow_energy) begin
                    factor <=
                        step_is_narrow_square ? ((|fit_20[25:24]) ? {24{1'b1}} : fit_20[23:0])
                        : (|fit_27[24]) ? {24{1'b1}} : fit_27[23:0];
                end
                if (step_is_load) begin
                    left <= capacitance;
                    right <= capacitance;
                end else begin
                    left <= factor;
                    right <= {2'd0, (step == 4'd4) ? mean_square : {4'd0, gain}};
                end
            end else begin
                waited <= 1'd1;
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, choice_55[4]};

endmodule

`default_nettype wire
