// currents: hapticore_model::blocks::currents::Currents
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module currents (
    input wire clock,
    input wire reset,
    input wire valid, // u1.0  A sum is there.
    input wire [3:0] index, // u4.0  Which.
    input wire signed [39:0] sum, // s40.30  The sum.
    output reg done, // u1.0  Set for one clock when all others are there.
    output wire [15:0] total, // u16.13  The amplitude of the total current.
    output reg [15:0] sense, // u16.13  The amplitude of the sensing voltage.
    output reg signed [19:0] x, // s20.13  The numerator of r_x.
    output reg signed [19:0] y, // s20.13  The numerator of r_y.
    output reg [18:0] corners, // u19.13  Their denominator.
    output wire lost, // u1.0  Whether a terminal's current is missing.
    output reg saturated // u1.0  Whether a word is held at a rail.
);

    reg [2:0] step; // u3.0  0 idle, 1 read, 2 in_phase, 3 quadrature, 4 power, 5 root
    reg [2:0] channel; // u3.0
    reg signed [14:0] total_i; // s15.13
    reg signed [14:0] total_q; // s15.13
    reg signed [14:0] part; // s15.13
    reg [29:0] power; // u30.26
    reg root_start; // u1.0
    reg [15:0] amplitude; // u16.13
    reg [15:0] least; // u16.13
    reg signed [13:0] words [0:13]; // 14 words s14.13
    reg signed [13:0] words_word; // its read register
    wire root_done; // u1.0
    wire [15:0] root_root; // u16.13

    wire bit_22 = ~(step == 3'd0); // u1.0
    wire signed [16:0] fit_26 = {sum[39], sum[39:24]} + {16'd0, sum[23] & (sum[24] | (|sum[22:0]))}; // s17.13
    wire signed [13:0] words_write_word =
        (fit_26[16:13] == {4{fit_26[16]}}) ? fit_26[13:0] : {fit_26[16], {13{~fit_26[16]}}}; // s14.13
    wire less_31 = index < 4'd14; // u1.0
    wire step_is_in_phase = step == 3'd2; // u1.0
    wire [3:0] joined_35 = {channel, step_is_in_phase}; // u4.0
    wire equal_41 = index == 4'd0; // u1.0
    wire less_43 = index < 4'd12; // u1.0
    wire signed [14:0] choice_46 = equal_41 ? 15'd0 : total_i; // s15.13
    wire signed [14:0] choice_47 = equal_41 ? 15'd0 : total_q; // s15.13
    wire signed [15:0] sum_48 = {{1{choice_46[14]}}, choice_46} + {{2{words_write_word[13]}}, words_write_word}; // s16.13
    wire signed [16:0] fit_49 = {{1{sum_48[15]}}, sum_48}; // s17.13
    wire signed [14:0] fit_50 =
        (fit_49[16:14] == {3{fit_49[16]}}) ? fit_49[14:0] : {fit_49[16], {14{~fit_49[16]}}}; // s15.13
    wire signed [15:0] sum_53 = {{1{choice_47[14]}}, choice_47} + {{2{words_write_word[13]}}, words_write_word}; // s16.13
    wire signed [16:0] fit_54 = {{1{sum_53[15]}}, sum_53}; // s17.13
    wire signed [14:0] fit_55 =
        (fit_54[16:14] == {3{fit_54[16]}}) ? fit_54[14:0] : {fit_54[16], {14{~fit_54[16]}}}; // s15.13
    wire bit_59 = less_43 & (index[0] ? (~({{2{fit_55[14]}}, fit_55} == fit_54)) : (~({{2{fit_50[14]}}, fit_50} == fit_49))); // u1.0
    wire bit_72 = ((~equal_41) & saturated) | (less_31 & (~({{3{words_write_word[13]}}, words_write_word} == fit_26))); // u1.0
    wire channel_is_7 = channel == 3'd7; // u1.0
    wire [28:0] product_76 = part * part; // u29.26
    wire step_is_power = step == 3'd4; // u1.0
    wire [30:0] choice_80 = step_is_power ? ({1'd0, power} + {2'd0, product_76}) : {2'd0, product_76}; // u31.26
    wire step_is_root = step == 3'd5; // u1.0
    wire bit_84 = step_is_root & root_done; // u1.0
    wire channel_is_0 = channel == 3'd0; // u1.0
    wire [3:0] sum_91 = {1'd0, channel} + 4'd1; // u4.0
    wire channel_is_2 = channel == 3'd2; // u1.0
    wire channel_is_3 = channel == 3'd3; // u1.0
    wire channel_is_1 = channel == 3'd1; // u1.0
    wire bit_102 = channel_is_0 | channel_is_1; // u1.0
    wire signed [19:0] choice_105 = channel_is_0 ? 20'd0 : x; // s20.13
    wire signed [20:0] sum_106 = {{1{choice_105[19]}}, choice_105} + {5'd0, (channel_is_2 | channel_is_3) ? root_root : 16'd0}; // s21.13
    wire signed [21:0] difference_107 = {{1{sum_106[20]}}, sum_106} - {6'd0, bit_102 ? root_root : 16'd0}; // s22.13
    wire signed [19:0] choice_113 = channel_is_0 ? 20'd0 : y; // s20.13
    wire signed [20:0] sum_114 = {{1{choice_113[19]}}, choice_113} + {5'd0, (channel_is_0 | channel_is_3) ? root_root : 16'd0}; // s21.13
    wire signed [21:0] difference_115 = {{1{sum_114[20]}}, sum_114} - {6'd0, (channel_is_1 | channel_is_2) ? root_root : 16'd0}; // s22.13
    wire [19:0] sum_123 = {1'd0, channel_is_0 ? 19'd0 : corners} + {4'd0, ((bit_102 | channel_is_2) | channel_is_3) ? root_root : 16'd0}; // u20.13
    wire signed [20:0] difference_124 = {1'd0, sum_123} - {5'd0, 1'd0 ? root_root : 16'd0}; // s21.13
    wire [2:0] choice_127 = bit_84 ? step : step; // u3.0
    wire signed [14:0] choice_129 = bit_84 ? total_i : total_i; // s15.13
    wire signed [14:0] choice_130 = bit_84 ? total_q : total_q; // s15.13
    wire step_is_quadrature = step == 3'd3; // u1.0
    wire [3:0] choice_149 =
        bit_84 ? {3'd0, channel_is_7 ? 1'd0
        : 1'd1}
        : step_is_root ? {1'd0, choice_127}
        : ({1'd0, choice_127} + 4'd1); // u4.0

    root u_root (
        .clock(clock),
        .reset(reset),
        .start(root_start),
        .radicand(power),
        .done(root_done),
        .root(root_root)
    );

    initial begin : initial_words
        integer i;
        for (i = 0; i < 14; i = i + 1) words[i] = 14'd0;
    end

    always @(posedge clock) begin
        if (valid & less_31) words[index] <= words_write_word;
        words_word <= words[joined_35];
    end

    always @(posedge clock) begin
        if (reset) begin
            step <= 3'd0;
            channel <= 3'd0;
            total_i <= 15'd0;
            total_q <= 15'd0;
            part <= 15'd0;
            power <= 30'd0;
            root_start <= 1'd0;
            amplitude <= 16'd0;
            sense <= 16'd0;
            x <= 20'd0;
            y <= 20'd0;
            corners <= 19'd0;
            least <= 16'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            if (valid) begin
                channel <= 3'd0;
                total_i <= (less_43 & (~index[0])) ? fit_50 : choice_46;
                total_q <= (less_43 & index[0]) ? fit_55 : choice_47;
                root_start <= 1'd0;
                saturated <= bit_72 | bit_59;
                done <= 1'd0;
                if (index == 4'd13) begin
                    step <= 3'd1;
                end
            end else if (bit_22) begin
                step <= choice_149[2:0];
                total_i <= choice_129;
                total_q <= choice_130;
                part <=
                    step_is_in_phase ? (channel_is_7 ? choice_129
                    : {{1{words_word[13]}}, words_word})
                    : step_is_quadrature ? (channel_is_7 ? choice_130
                    : {{1{words_word[13]}}, words_word})
                    : bit_84 ? part
                    : part;
                power <= (step_is_quadrature | step_is_power) ? choice_80[29:0] : bit_84 ? power : power;
                root_start <= step_is_power;
                done <= bit_84 & channel_is_7;
                if (bit_84) begin
                    channel <= sum_91[2:0];
                    amplitude <= root_root;
                    x <= difference_107[19:0];
                    y <= difference_115[19:0];
                    corners <= difference_124[18:0];
                    if (channel_is_0 | ((channel < 3'd6) & (root_root < least))) begin
                        least <= root_root;
                    end
                    if (channel == 3'd6) begin
                        sense <= root_root;
                    end
                end
            end else begin
                root_start <= 1'd0;
                done <= 1'd0;
            end
        end
    end

    assign total = amplitude;
    assign lost = {least, 9'd0} < {9'd0, amplitude};

    // What nothing needs.
    wire unused = &{1'b0, choice_80[30], sum_91[3], difference_107[21:20], difference_115[21:20],
        difference_124[20:19], choice_149[3]};

endmodule

`default_nettype wire
