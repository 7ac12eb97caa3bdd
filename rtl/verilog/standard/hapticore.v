// hapticore: hapticore_model::blocks::core::Core
// Printed from the model by `hapticore hdl --profile standard`; not to be edited.

`default_nettype none

module hapticore (
    input wire clock,
    input wire reset,
    input wire strobe, // u1.0  A set of ADC codes is there.
    input wire clear, // u1.0  Abandons the slot under way: the next strobe is the first of the first pad's slot.
    input wire signed [17:0] code, // s18.17  The code of the channel asked for in the clock before.
    input wire [17:0] capacitance_gain, // u18.7  Calibration: picofarads at an admittance of one.
    input wire [17:0] force_gain, // u18.34  Calibration: newtons per square picofarad at full haptic mean square.
    input wire write, // u1.0  Calibration: writes a word of the position table.
    input wire [12:0] address, // u13.0  Calibration: where.
    input wire signed [17:0] word, // s18.17  Calibration: what.
    output wire [2:0] channel, // u3.0  The channel whose code is wanted.
    output wire [1:0] serve, // u2.0  The pad that is served.
    output wire closed, // u1.0  Whether its switch is made.
    output wire signed [17:0] carrier, // s18.17  The carrier.
    output wire valid, // u1.0  Set for a clock for each word of a frame.
    output wire [2:0] index, // u3.0  Which field the word is.
    output wire signed [24:0] frame, // s25.0  The word.
    output wire done, // u1.0  Set with a frame's last word.
    output wire [1:0] pad, // u2.0  The pad of the frame.
    output wire clipped, // u1.0  A code was at a rail of the ADC.
    output wire saturated, // u1.0  A word was held at a rail.
    output wire invalid, // u1.0  The last valid results stand.
    output wire lost, // u1.0  A terminal's current is that of an open one.
    output wire overrun // u1.0  Strobes have come closer than the profile's clocks a sample since reset or `clear`: frames are wrong.
);

    wire multiplexer_sample; // u1.0
    wire multiplexer_restart; // u1.0
    wire multiplexer_integrate; // u1.0
    wire multiplexer_first; // u1.0
    wire multiplexer_last; // u1.0
    wire [1:0] multiplexer_pad; // u2.0
    wire multiplexer_closed; // u1.0
    wire pace_overrun; // u1.0
    wire oscillator_ready; // u1.0
    wire signed [17:0] oscillator_cosine; // s18.17
    wire signed [17:0] oscillator_sine; // s18.17
    wire signed [17:0] oscillator_window; // s18.17
    wire oscillator_phase; // u1.0
    wire [2:0] demodulator_channel; // u3.0
    wire demodulator_valid; // u1.0
    wire [3:0] demodulator_index; // u4.0
    wire signed [44:0] demodulator_sum; // s45.34
    wire [1:0] demodulator_pad; // u2.0
    wire demodulator_clipped; // u1.0
    wire estimator_valid; // u1.0
    wire [2:0] estimator_index; // u3.0
    wire signed [24:0] estimator_word; // s25.0
    wire estimator_done; // u1.0
    wire [1:0] estimator_pad; // u2.0
    wire estimator_clipped; // u1.0
    wire estimator_saturated; // u1.0
    wire estimator_invalid; // u1.0
    wire estimator_lost; // u1.0

    multiplexer u_multiplexer (
        .clock(clock),
        .reset(reset),
        .strobe(strobe),
        .clear(clear),
        .sample(multiplexer_sample),
        .restart(multiplexer_restart),
        .integrate(multiplexer_integrate),
        .first(multiplexer_first),
        .last(multiplexer_last),
        .pad(multiplexer_pad),
        .closed(multiplexer_closed)
    );

    pace u_pace (
        .clock(clock),
        .reset(reset),
        .strobe(strobe),
        .clear(clear),
        .overrun(pace_overrun)
    );

    oscillator u_oscillator (
        .clock(clock),
        .reset(reset),
        .sample(multiplexer_sample),
        .restart(multiplexer_restart),
        .first(multiplexer_first),
        .ready(oscillator_ready),
        .cosine(oscillator_cosine),
        .sine(oscillator_sine),
        .window(oscillator_window),
        .phase(oscillator_phase)
    );

    demodulator u_demodulator (
        .clock(clock),
        .reset(reset),
        .start(oscillator_ready & multiplexer_integrate),
        .first(multiplexer_first),
        .last(multiplexer_last),
        .pad(multiplexer_pad),
        .code(code),
        .cosine(oscillator_cosine),
        .sine(oscillator_sine),
        .window(oscillator_window),
        .phase(oscillator_phase),
        .channel(demodulator_channel),
        .valid(demodulator_valid),
        .index(demodulator_index),
        .sum(demodulator_sum),
        .pad_out(demodulator_pad),
        .clipped(demodulator_clipped)
    );

    estimator u_estimator (
        .clock(clock),
        .reset(reset),
        .clear(clear),
        .valid(demodulator_valid),
        .index(demodulator_index),
        .sum(demodulator_sum),
        .pad(demodulator_pad),
        .clipped(demodulator_clipped),
        .capacitance_gain(capacitance_gain),
        .force_gain(force_gain),
        .write(write),
        .address(address),
        .word(word),
        .valid_out(estimator_valid),
        .index_out(estimator_index),
        .word_out(estimator_word),
        .done(estimator_done),
        .pad_out(estimator_pad),
        .clipped_out(estimator_clipped),
        .saturated(estimator_saturated),
        .invalid(estimator_invalid),
        .lost(estimator_lost)
    );

    assign channel = demodulator_channel;
    assign serve = multiplexer_pad;
    assign closed = multiplexer_closed;
    assign carrier = oscillator_cosine;
    assign valid = estimator_valid;
    assign index = estimator_index;
    assign frame = estimator_word;
    assign done = estimator_done;
    assign pad = estimator_pad;
    assign clipped = estimator_clipped;
    assign saturated = estimator_saturated;
    assign invalid = estimator_invalid;
    assign lost = estimator_lost;
    assign overrun = pace_overrun;

endmodule

`default_nettype wire
