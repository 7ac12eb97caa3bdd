// currents: hapticore_model::blocks::currents::Currents
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module currents (
    input wire clock,
    input wire reset,
    input wire valid, // u1.0  A sum is there.
    input wire [3:0] index, // u4.0  Which.
    input wire signed [41:0] sum, // s42.31  The sum.
    output reg done, // u1.0  Set for one clock when all others are there.
    output wire [15:0] total, // u16.13  The amplitude of the total current.
    output reg [15:0] sense, // u16.13  The amplitude of the sensing voltage.
    output reg signed [19:0] x, // s20.13  The numerator of r_x.
    output reg signed [19:0] y, // s20.13  The numerator of r_y.
    output reg [18:0] corners, // u19.13  Their denominator.
    output wire lost, // u1.0  Whether a terminal's current is missing.
    output reg saturated // u1.0  Whether a word is held at a rail.
);

    reg [2:0] step; // u3.0  0 idle, 1 read, 2 in_phase, 3 read_quadrature, 4 quadrature, 5 square, 6 power, 7 root, 8 align_read, 9 align_load, 10 align_move, 11 align_keep, 12 restore
    reg arrived; // u1.0
    reg [3:0] place; // u4.0
    reg signed [13:0] word; // s14.13
    reg [2:0] channel; // u3.0
    reg signed [14:0] total_i; // s15.13
    reg signed [14:0] total_q; // s15.13
    reg signed [14:0] part; // s15.13
    reg [29:0] power; // u30.26
    reg root_start; // u1.0
    reg [15:0] least; // u16.13
    (* no_rw_check *) // nobody uses a word that was read while it was being written
    reg signed [13:0] words [0:15]; // 16 words s14.13
    reg signed [13:0] words_word; // its read register
    wire root_done; // u1.0
    wire [15:0] root_root; // u16.13
    wire signed [29:0] multiplier_product; // s30.0

    wire multiplier_enable = ~(step == 3'd0); // u1.0
    wire signed [23:0] fit_40 = {sum[41], sum[41:19]} + {23'd0, sum[18] & (sum[19] | (|sum[17:0]))}; // s24.13
    wire among = index < 4'd14; // u1.0
    wire [3:0] joined_56 = {channel, ~(step < 3'd3)}; // u4.0
    wire step_is_root = step == 3'd7; // u1.0
    wire channel_is_7 = channel == 3'd7; // u1.0
    wire less_63 = channel < 3'd6; // u1.0
    wire step_is_power = step == 3'd6; // u1.0
    wire [30:0] choice_68 =
        step_is_power ? ({1'd0, power} + {1'd0, multiplier_product})
        : {1'd0, multiplier_product}; // u31.26
    wire adds = ((step == 3'd3) | (step == 3'd5)) & less_63; // u1.0
    wire signed [15:0] more = {{1{total_i[14]}}, total_i} + {{1{part[14]}}, part}; // s16.13
    wire signed [16:0] fit_76 = {{1{more[15]}}, more}; // s17.13
    wire rooted = step_is_root & root_done; // u1.0
    wire channel_is_0 = channel == 3'd0; // u1.0
    wire signed [16:0] negative = 17'd0 - {1'd0, root_root}; // s17.13
    wire [3:0] sum_90 = {1'd0, channel} + 4'd1; // u4.0
    wire channel_is_2 = channel == 3'd2; // u1.0
    wire channel_is_3 = channel == 3'd3; // u1.0
    wire channel_is_1 = channel == 3'd1; // u1.0
    wire bit_101 = channel_is_0 | channel_is_1; // u1.0
    wire signed [19:0] choice_104 = channel_is_0 ? 20'd0 : x; // s20.13
    wire signed [16:0] choice_102 = bit_101 ? negative : {1'd0, (channel_is_2 | channel_is_3) ? root_root : 16'd0}; // s17.13
    wire signed [20:0] sum_105 = {{1{choice_104[19]}}, choice_104} + {{4{choice_102[16]}}, choice_102}; // s21.13
    wire signed [19:0] choice_111 = channel_is_0 ? 20'd0 : y; // s20.13
    wire signed [16:0] choice_110 =
        (channel_is_1 | channel_is_2) ? negative
        : {1'd0, (channel_is_0 | channel_is_3) ? root_root
        : 16'd0}; // s17.13
    wire signed [20:0] sum_112 = {{1{choice_111[19]}}, choice_111} + {{4{choice_110[16]}}, choice_110}; // s21.13
    wire signed [16:0] fit_117 = {1'd0, ((bit_101 | channel_is_2) | channel_is_3) ? root_root : 16'd0}; // s17.13
    wire signed [20:0] sum_120 = {2'd0, channel_is_0 ? 19'd0 : corners} + {{4{fit_117[16]}}, fit_117}; // s21.13
    wire step_is_quadrature = step == 3'd4; // u1.0
    wire [3:0] choice_139 =
        rooted ? {3'd0, channel_is_7 ? 1'd0
        : 1'd1}
        : step_is_root ? {1'd0, step}
        : ({1'd0, step} + 4'd1); // u4.0
    wire bit_170 = ((~(index == 4'd0)) & saturated) | (among & (~((fit_40[23:13] == 11'd0) | (fit_40[23:13] == 11'd2047)))); // u1.0
    wire next_arrived = valid & among; // u1.0

    root u_root (
        .clock(clock),
        .reset(reset),
        .start(root_start),
        .radicand(power),
        .done(root_done),
        .root(root_root)
    );

    multiplier_2 u_multiplier (
        .clock(clock),
        .reset(reset),
        .enable(multiplier_enable),
        .left(part),
        .right(part),
        .product(multiplier_product)
    );

    initial begin : initial_words
        integer i;
        for (i = 0; i < 16; i = i + 1) words[i] = 14'd0;
    end

    always @(posedge clock) begin
        if (arrived) words[place] <= word;
        words_word <= words[joined_56];
    end

    always @(posedge clock) begin
        if (reset) begin
            step <= 3'd0;
            arrived <= 1'd0;
            place <= 4'd0;
            word <= 14'd0;
            channel <= 3'd0;
            total_i <= 15'd0;
            total_q <= 15'd0;
            part <= 15'd0;
            power <= 30'd0;
            root_start <= 1'd0;
            sense <= 16'd0;
            x <= 20'd0;
            y <= 20'd0;
            corners <= 19'd0;
            least <= 16'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            arrived <= next_arrived;
            if (next_arrived) begin
                place <= index;
                word <=
                    (fit_40[23:13] == {11{fit_40[23]}}) ? fit_40[13:0] : {fit_40[23], {13{~fit_40[23]}}};
            end
            if (valid) begin
                channel <= 3'd0;
                total_i <= 15'd0;
                total_q <= 15'd0;
                root_start <= 1'd0;
                saturated <= bit_170;
                done <= 1'd0;
                if (index == 4'd14) begin
                    step <= 3'd1;
                end
            end else if (multiplier_enable) begin
                step <= choice_139[2:0];
                part <=
                    (step == 3'd2) ? (channel_is_7 ? total_i
                    : {{1{words_word[13]}}, words_word})
                    : step_is_quadrature ? (channel_is_7 ? total_q
                    : {{1{words_word[13]}}, words_word})
                    : part;
                root_start <= step_is_power;
                saturated <= saturated | (adds & (~((fit_76[16:14] == 3'd0) | (fit_76[16:14] == 3'd7))));
                done <= rooted & channel_is_7;
                if (step_is_quadrature | step_is_power) begin
                    power <= choice_68[29:0];
                end
                if (adds) begin
                    total_i <= total_q;
                    total_q <=
                        (fit_76[16:14] == {3{fit_76[16]}}) ? fit_76[14:0] : {fit_76[16], {14{~fit_76[16]}}};
                end
                if (rooted) begin
                    channel <= sum_90[2:0];
                    x <= sum_105[19:0];
                    y <= sum_112[19:0];
                    corners <= sum_120[18:0];
                    if (channel_is_0 | (less_63 & (root_root < least))) begin
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

    assign total = root_root;
    assign lost = {least, 9'd0} < {9'd0, root_root};

    // What nothing needs.
    wire unused = &{1'b0, choice_68[30], sum_90[3], sum_105[20], sum_112[20], sum_120[20:19], choice_139[3]};

endmodule

`default_nettype wire
