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

    reg [3:0] step; // u4.0  0 idle, 1 load, 2 square, 3 narrow_square, 4 weigh, 5 energy, 6 narrow_energy, 7 scale, 8 gain_product, 9 finish
    reg [14:0] left; // u15.0
    reg [14:0] right; // u15.0
    reg [14:0] factor; // u15.-5
    wire [29:0] multiplier_product; // u30.0

    wire step_is_idle = step == 4'd0; // u1.0
    wire [15:0] fit_20 = {1'b0, multiplier_product[29:15]} + {15'd0, multiplier_product[14] & (multiplier_product[15] | (|multiplier_product[13:0]))}; // u16.-5
    wire bit_24 = ~(fit_20[15] == 1'd0); // u1.0
    wire [16:0] fit_26 = {1'b0, multiplier_product[29:14]} + {16'd0, multiplier_product[13] & (multiplier_product[14] | (|multiplier_product[12:0]))}; // u17.12
    wire step_is_narrow_square = step == 4'd3; // u1.0
    wire step_is_narrow_energy = step == 4'd6; // u1.0
    wire step_is_finish = step == 4'd9; // u1.0
    wire bit_44 = ((step_is_narrow_square & bit_24) | (step_is_narrow_energy & bit_24)) | (step_is_finish & (~(fit_26[16:15] == 2'd0))); // u1.0
    wire [4:0] choice_46 = step_is_finish ? 5'd0 : ({1'd0, step} + 5'd1); // u5.0
    wire step_is_load = step == 4'd1; // u1.0

    multiplier_3 u_multiplier (
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
            left <= 15'd0;
            right <= 15'd0;
            factor <= 15'd0;
            haptic_force <= 15'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                step <= 4'd1;
                saturated <= 1'd0;
                done <= 1'd0;
            end else if (step_is_idle) begin
                done <= 1'd0;
            end else begin
                step <= choice_46[3:0];
                saturated <= saturated | bit_44;
                done <= step_is_finish;
                if (step_is_finish) begin
                    haptic_force <= (|fit_26[16:15]) ? {15{1'b1}} : fit_26[14:0];
                end
                if (step_is_narrow_square | step_is_narrow_energy) begin
                    factor <= (|fit_20[15]) ? {15{1'b1}} : fit_20[14:0];
                end
                if (step_is_load) begin
                    left <= capacitance;
                    right <= capacitance;
                end else begin
                    left <= factor;
                    right <= (step == 4'd4) ? mean_square : gain;
                end
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, choice_46[4]};

endmodule

`default_nettype wire
