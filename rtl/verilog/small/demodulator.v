// demodulator: hapticore_model::blocks::demodulator::Demodulator
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module demodulator (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  The oscillator's outputs are those of a sample to be integrated.
    input wire first, // u1.0  The sample is the first of its window.
    input wire last, // u1.0  The sample is the last of its window.
    input wire [1:0] pad, // u2.0  The pad that is served.
    input wire signed [15:0] code, // s16.15  The code of the channel asked for in the clock before.
    input wire signed [16:0] cosine, // s17.16  The oscillator's.
    input wire signed [16:0] sine, // s17.16  The oscillator's.
    input wire signed [16:0] window, // s17.16  The oscillator's.
    input wire [2:0] phase, // u3.0  The oscillator's.
    output wire [2:0] channel, // u3.0  The channel whose code is wanted in the next clock.
    output reg valid, // u1.0  Set for a clock for each finished sum of a window.
    output wire [3:0] index, // u4.0  Which sum: 2k the in-phase and 2k + 1 the quadrature of channel k, the last the mean square.
    output reg signed [41:0] sum, // s42.31  The sum.
    output wire [1:0] pad_out, // u2.0  The pad of the window.
    output reg clipped // u1.0  Whether a code of the window was at a rail.
);

    reg busy; // u1.0
    reg [3:0] step; // u4.0
    reg first_q; // u1.0
    reg last_q; // u1.0
    reg [1:0] pad_q; // u2.0
    reg [15:0] left; // u16.0
    reg [15:0] right; // u16.0
    reg [15:0] weighted; // u16.0
    reg summed; // u1.0
    reg [5:0] index_q; // u6.0
    reg fresh; // u1.0
    reg [2:0] phase_q; // u3.0
    reg reading; // u1.0
    reg [1:0] beat; // u2.0
    reg [2:0] tap; // u3.0
    reg high; // u1.0
    reg part; // u1.0
    reg [2:0] channel_q; // u3.0
    (* no_rw_check *) // nobody uses a word that was read while it was being written
    reg signed [41:0] sums [0:63]; // 64 words s42.31
    reg signed [41:0] sums_word; // its read register
    wire [31:0] multiplier_product; // u32.0

    wire channel_is_7 = channel_q == 3'd7; // u1.0
    wire step_is_10 = step == 4'd10; // u1.0
    wire bit_53 = ~channel_is_7; // u1.0
    wire signed [41:0] choice_59 = part ? 42'h3fea7fc0000 : 42'h3fe96480000; // s42.31
    wire signed [42:0] carried = {25'd0, sum[33:16]} + {{1{choice_59[41]}}, choice_59}; // s43.31
    wire tap_is_0 = tap == 3'd0; // u1.0
    wire signed [41:0] so_far =
        (reading & bit_53) ? (tap_is_0 ? (high ? carried[41:0]
        : 42'd0)
        : sum)
        : ((step_is_10 ? first_q
        : fresh) & (~reading)) ? 42'd0
        : sums_word; // s42.31
    wire signed [42:0] accumulated = {{1{so_far[41]}}, so_far} + {11'd0, multiplier_product}; // s43.31
    wire signed [4:0] difference_72 = {1'd0, step} - 5'd2; // s5.0
    wire signed [4:0] difference_79 = {1'd0, step} - 5'd3; // s5.0
    wire tap_is_3 = tap == 3'd3; // u1.0
    wire tap_is_4 = tap == 3'd4; // u1.0
    wire bit_92 = (tap == 3'd1) | tap_is_4; // u1.0
    wire beat_is_3 = beat == 2'd3; // u1.0
    wire result = (tap_is_4 & high) | channel_is_7; // u1.0
    wire [3:0] choice_109 = tap_is_4 ? 4'd0 : ({1'd0, tap} + 4'd1); // u4.0
    wire [3:0] sum_126 = {1'd0, channel_q} + {3'd0, result & part}; // u4.0
    wire beat_is_1 = beat == 2'd1; // u1.0
    wire [2:0] sum_132 = {1'd0, beat} + 3'd1; // u3.0
    wire [15:0] limb = high ? sums_word[37:22] : sums_word[21:6]; // u16.0
    wire signed [16:0] difference_147 = 17'd65535 - {1'd0, limb}; // s17.0
    wire step_is_8 = step == 4'd8; // u1.0
    wire signed [17:0] sum_173 = {{2{code[15]}}, code} + 18'd32768; // s18.15
    wire step_is_2 = step == 4'd2; // u1.0
    wire [4:0] choice_187 = step_is_10 ? 5'd0 : ({1'd0, step} + 5'd1); // u5.0
    wire [15:0] fit_189 = multiplier_product[30:15] + {15'd0, multiplier_product[14] & (multiplier_product[15] | (|multiplier_product[13:0]))}; // u16.16

    multiplier u_multiplier (
        .clock(clock),
        .reset(reset),
        .enable(busy | reading),
        .left(left),
        .right(right),
        .product(multiplier_product)
    );

    initial begin : initial_sums
        integer i;
        for (i = 0; i < 64; i = i + 1) sums[i] = 42'd0;
    end

    always @(posedge clock) begin
        if (summed) sums[index_q] <= sum;
        sums_word <= sums[reading ? {tap, channel_q} : {(difference_72[2:0] == 3'd7) ? 3'd0 : phase_q, difference_72[2:0]}];
    end

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            step <= 4'd0;
            first_q <= 1'd0;
            last_q <= 1'd0;
            pad_q <= 2'd0;
            left <= 16'd0;
            right <= 16'd0;
            weighted <= 16'd0;
            valid <= 1'd0;
            summed <= 1'd0;
            index_q <= 6'd0;
            sum <= 42'd0;
            clipped <= 1'd0;
            fresh <= 1'd0;
            phase_q <= 3'd0;
            reading <= 1'd0;
            beat <= 2'd0;
            tap <= 3'd0;
            high <= 1'd0;
            part <= 1'd0;
            channel_q <= 3'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                step <= 4'd0;
                first_q <= first;
                last_q <= last;
                pad_q <= pad;
                valid <= 1'd0;
                summed <= 1'd0;
                fresh <= first | (fresh & (~(phase == 3'd0)));
                phase_q <= phase;
                if (first) begin
                    clipped <= 1'd0;
                end
            end else if (busy) begin
                busy <= ~step_is_10;
                step <= choice_187[3:0];
                left <= ((step == 4'd0) | step_is_8) ? (code[15] ? 16'd0 - code : code) : sum_173[15:0];
                right <= step_is_8 ? weighted : window[15:0];
                valid <= 1'd0;
                summed <= ~(step_is_2 | (step < 4'd2));
                index_q <= {(difference_79[2:0] == 3'd7) ? 3'd0 : phase_q, difference_79[2:0]};
                sum <= accumulated[41:0];
                clipped <= clipped | ((step < 4'd9) ? ((code == 16'd32767) | (code == 16'h8000)) : 1'd0);
                reading <= step_is_10 & last_q;
                if (step_is_2) begin
                    weighted <= fit_189;
                end
            end else begin
                summed <= 1'd0;
                if (reading) begin
                    valid <= beat_is_3 & result;
                    reading <= ~(beat_is_3 & channel_is_7);
                    beat <= sum_132[1:0];
                    if (beat_is_1) begin
                        left <=
                            (part ? (tap_is_3 | tap_is_4)
                            : ((tap == 3'd2) | tap_is_3)) ? difference_147[15:0]
                            : limb;
                        right <=
                            part ? (tap_is_0 ? 16'd0
                            : bit_92 ? 16'd54429
                            : 16'd33639)
                            : tap_is_0 ? 16'd57230
                            : bit_92 ? 16'd17685
                            : 16'd46300;
                    end
                    if (beat_is_3) begin
                        index_q <= {2'd0, {channel_q, part & bit_53}};
                        sum <= accumulated[41:0];
                        high <= ((high & (~tap_is_4)) | (tap_is_4 & (~high))) & bit_53;
                        part <= (((part & (~result)) | (result & (~part))) | ((channel_q == 3'd6) & part)) & bit_53;
                        if (channel_is_7) begin
                            tap <= 3'd0;
                            channel_q <= 3'd0;
                        end else begin
                            tap <= choice_109[2:0];
                            channel_q <= sum_126[2:0];
                        end
                    end
                end else begin
                    valid <= 1'd0;
                end
            end
        end
    end

    assign channel = (busy & (step < 4'd7)) ? step[2:0] : 3'd7;
    assign index = index_q[3:0];
    assign pad_out = pad_q;

    // What nothing needs.
    wire unused = &{1'b0, cosine, sine, window[16], carried[42], accumulated[42], difference_72[4:3],
        difference_79[4:3], choice_109[3], sum_126[3], sum_132[2], difference_147[16], sum_173[17:16], choice_187[4]};

endmodule

`default_nettype wire
