// estimator: hapticore_model::blocks::estimator::Estimator
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module estimator (
    input wire clock,
    input wire reset,
    input wire clear, // u1.0  Mean squares of windows before count no more.
    input wire valid, // u1.0  A sum is there.
    input wire [3:0] index, // u4.0  Which.
    input wire signed [41:0] sum, // s42.31  The sum.
    input wire [1:0] pad, // u2.0  The pad of the window.
    input wire clipped, // u1.0  Whether a code of the window was at a rail.
    input wire [14:0] capacitance_gain, // u15.5  Calibration: picofarads at an admittance of one.
    input wire [14:0] force_gain, // u15.31  Calibration: newtons per square picofarad at full haptic mean square.
    input wire write, // u1.0  Calibration: writes a word of the position table.
    input wire [10:0] address, // u11.0  Calibration: where.
    input wire signed [15:0] word, // s16.15  Calibration: what.
    output wire valid_out, // u1.0  Set for a clock for each word of a frame.
    output wire [2:0] index_out, // u3.0  Which field the word is.
    output wire signed [15:0] word_out, // s16.0  The word.
    output wire done, // u1.0  Set with the last word.
    output wire [1:0] pad_out, // u2.0  The pad of the frame.
    output wire clipped_out, // u1.0  A code was at a rail of the ADC.
    output wire saturated, // u1.0  A word was held at a rail.
    output wire invalid, // u1.0  There is no such position or capacitance; the last valid results stand.
    output wire lost // u1.0  A terminal's current is that of an open one.
);

    reg [1:0] pad_q; // u2.0
    reg clipped_q; // u1.0
    wire currents_done; // u1.0
    wire [15:0] currents_total; // u16.13
    wire [15:0] currents_sense; // u16.13
    wire signed [20:0] currents_x; // s21.15
    wire signed [20:0] currents_y; // s21.15
    wire [19:0] currents_corners; // u20.15
    wire [16:0] currents_least; // u17.15
    wire currents_saturated; // u1.0
    wire [14:0] haptic_voltage_mean_square; // u15.15
    wire haptic_voltage_saturated; // u1.0
    wire ratio_done; // u1.0
    wire signed [17:0] ratio_r_x; // s18.16
    wire signed [17:0] ratio_r_y; // s18.16
    wire [16:0] ratio_share; // u17.16
    wire ratio_invalid; // u1.0
    wire position_done; // u1.0
    wire signed [15:0] position_x; // s16.5
    wire signed [15:0] position_y; // s16.5
    wire [14:0] position_sheet; // u15.15
    wire position_invalid; // u1.0
    wire position_lost; // u1.0
    wire position_saturated; // u1.0
    wire capacitance_done; // u1.0
    wire [14:0] capacitance_capacitance; // u15.5
    wire capacitance_invalid; // u1.0
    wire capacitance_saturated; // u1.0
    wire force_estimator_done; // u1.0
    wire [14:0] force_estimator_haptic_force; // u15.12
    wire force_estimator_saturated; // u1.0
    wire frames_valid; // u1.0
    wire [2:0] frames_index; // u3.0
    wire signed [15:0] frames_word; // s16.0
    wire frames_done; // u1.0

    wire [1:0] next_pad_q = valid ? pad : pad_q; // u2.0
    wire frames_invalid = (ratio_invalid | position_invalid) | capacitance_invalid; // u1.0
    wire signed [16:0] rounded = {ratio_r_x[17], ratio_r_x[17:2]} + {16'd0, ratio_r_x[1] & (ratio_r_x[2] | ratio_r_x[0])};
    wire signed [16:0] rounded_2 = {ratio_r_y[17], ratio_r_y[17:2]} + {16'd0, ratio_r_y[1] & (ratio_r_y[2] | ratio_r_y[0])};
    wire bit_57 = ((currents_saturated | haptic_voltage_saturated) | position_saturated) | capacitance_saturated; // u1.0
    wire any_saturated = bit_57 | force_estimator_saturated; // u1.0

    currents u_currents (
        .clock(clock),
        .reset(reset),
        .valid(valid),
        .index(index),
        .sum(sum),
        .done(currents_done),
        .total(currents_total),
        .sense(currents_sense),
        .x(currents_x),
        .y(currents_y),
        .corners(currents_corners),
        .least(currents_least),
        .saturated(currents_saturated)
    );

    haptic_voltage u_haptic_voltage (
        .clock(clock),
        .reset(reset),
        .clear(clear),
        .pad(next_pad_q),
        .valid(valid),
        .index(index),
        .sum(sum),
        .mean_square(haptic_voltage_mean_square),
        .saturated(haptic_voltage_saturated)
    );

    ratio u_ratio (
        .clock(clock),
        .reset(reset),
        .start(currents_done),
        .x(currents_x),
        .y(currents_y),
        .corners(currents_corners),
        .least(currents_least),
        .done(ratio_done),
        .r_x(ratio_r_x),
        .r_y(ratio_r_y),
        .share(ratio_share),
        .invalid(ratio_invalid)
    );

    position u_position (
        .clock(clock),
        .reset(reset),
        .start(ratio_done),
        .r_x(ratio_r_x),
        .r_y(ratio_r_y),
        .share(ratio_share),
        .write(write),
        .address(address),
        .word(word),
        .done(position_done),
        .x(position_x),
        .y(position_y),
        .sheet(position_sheet),
        .invalid(position_invalid),
        .lost(position_lost),
        .saturated(position_saturated)
    );

    capacitance u_capacitance (
        .clock(clock),
        .reset(reset),
        .start(position_done),
        .total(currents_total),
        .sense(currents_sense),
        .sheet(position_sheet),
        .gain(capacitance_gain),
        .done(capacitance_done),
        .capacitance(capacitance_capacitance),
        .invalid(capacitance_invalid),
        .saturated(capacitance_saturated)
    );

    force_estimator u_force_estimator (
        .clock(clock),
        .reset(reset),
        .start(capacitance_done),
        .capacitance(capacitance_capacitance),
        .mean_square(haptic_voltage_mean_square),
        .gain(force_gain),
        .done(force_estimator_done),
        .haptic_force(force_estimator_haptic_force),
        .saturated(force_estimator_saturated)
    );

    frames u_frames (
        .clock(clock),
        .reset(reset),
        .start(force_estimator_done),
        .pad(pad_q),
        .invalid(frames_invalid),
        .r_x((rounded[16:15] == {2{rounded[16]}}) ? rounded[15:0] : {rounded[16], {15{~rounded[16]}}}),
        .r_y((rounded_2[16:15] == {2{rounded_2[16]}}) ? rounded_2[15:0] : {rounded_2[16], {15{~rounded_2[16]}}}),
        .x(position_x),
        .y(position_y),
        .sheet(position_sheet),
        .capacitance(capacitance_capacitance),
        .haptic_force(force_estimator_haptic_force),
        .mean_square(haptic_voltage_mean_square),
        .valid(frames_valid),
        .index(frames_index),
        .word(frames_word),
        .done(frames_done)
    );

    always @(posedge clock) begin
        if (reset) begin
            pad_q <= 2'd0;
            clipped_q <= 1'd0;
        end else begin
            pad_q <= next_pad_q;
            if (valid) begin
                clipped_q <= clipped;
            end
        end
    end

    assign valid_out = frames_valid;
    assign index_out = frames_valid ? frames_index : 3'd0;
    assign word_out = frames_valid ? frames_word : 16'd0;
    assign done = frames_done;
    assign pad_out = pad_q;
    assign clipped_out = clipped_q;
    assign saturated = frames_valid ? any_saturated : 1'd0;
    assign invalid = frames_valid ? frames_invalid : 1'd0;
    assign lost = frames_valid ? position_lost : 1'd0;

endmodule

`default_nettype wire
