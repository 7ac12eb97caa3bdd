// map: hapticore_model::blocks::map::Map
// Printed from the model by `hapticore hdl --profile small`; not to be edited.

`default_nettype none

module map (
    input wire clock,
    input wire reset,
    input wire start, // u1.0  The ratios are there, and hold.
    input wire signed [17:0] r_x, // s18.16  The x ratio.
    input wire signed [17:0] r_y, // s18.16  The y ratio.
    input wire signed [17:0] origin_x, // s18.16  Calibration: the x ratio in the middle of the box.
    input wire [14:0] scale_x, // u15.10  Calibration: one over half the box's width.
    input wire signed [17:0] origin_y, // s18.16  Calibration: the y ratio in the middle of the box.
    input wire [14:0] scale_y, // u15.10  Calibration: one over half the box's height.
    input wire write, // u1.0  Calibration: writes a word of the tables.
    input wire [10:0] address, // u11.0  Calibration: where.
    input wire signed [15:0] word, // s16.15  Calibration: what.
    output reg done, // u1.0  Set for one clock when the others are there.
    output reg signed [15:0] x, // s16.6  The position along the long edges, in mm from the middle.
    output reg signed [15:0] y, // s16.6  The position along the short edges, in mm from the middle.
    output reg [14:0] sheet, // u15.15  The sheet's resistance at the pad, in full scales of voltage per current.
    output reg saturated // u1.0  Whether a word is held at a rail.
);

    reg busy; // u1.0
    reg [4:0] operation; // u5.0  0 box_x, 1 box_y, 2 middle_y, 3 stretch_y, 4 straighten_y, 5 spacing_y, 6 middle_x, 7 stretch_x, 8 straighten_x, 9 spacing_x, 10 x_above, 11 x_below, 12 x, 13 y_above, 14 y_below, 15 y, 16 r_above, 17 r_below, 18 r
    reg [2:0] step; // u3.0  0 coordinate, 1 near, 2 far, 3 difference, 4 multiply, 5 finish
    reg signed [15:0] p_x; // s16.15
    reg signed [15:0] p_y; // s16.15
    reg signed [15:0] middle; // s16.15
    reg signed [15:0] stretch; // s16.15
    reg signed [15:0] u; // s16.15
    reg signed [15:0] v; // s16.15
    reg signed [15:0] above; // s16.15
    reg signed [15:0] below; // s16.15
    reg [10:0] base; // u11.0
    reg signed [15:0] near; // s16.15
    reg signed [18:0] difference; // s19.0
    reg [14:0] factor; // u15.0
    reg signed [33:0] product; // s34.0
    reg signed [15:0] words [0:1384]; // 1385 words s16.15
    reg signed [15:0] words_word; // its read register

    wire step_is_far = step == 3'd2; // u1.0
    wire [11:0] sum_37 = {1'd0, base} + {11'd0, step_is_far}; // u12.0
    wire operation_is_box_x = operation == 5'd0; // u1.0
    wire operation_is_box_y = operation == 5'd1; // u1.0
    wire bit_43 = operation_is_box_x | operation_is_box_y; // u1.0
    wire operation_is_straighten_y = operation == 5'd4; // u1.0
    wire operation_is_straighten_x = operation == 5'd8; // u1.0
    wire bit_48 = operation_is_straighten_y | operation_is_straighten_x; // u1.0
    wire operation_is_x = operation == 5'd12; // u1.0
    wire operation_is_y = operation == 5'd15; // u1.0
    wire operation_is_r = operation == 5'd18; // u1.0
    wire bit_57 = (operation_is_x | operation_is_y) | operation_is_r; // u1.0
    wire bit_59 = ~((bit_43 | bit_48) | bit_57); // u1.0
    wire step_is_finish = step == 3'd5; // u1.0
    wire [3:0] choice_63 = step_is_finish ? 4'd0 : ({1'd0, step} + 4'd1); // u4.0
    wire signed [15:0] choice_66 = (step_is_far & bit_59) ? words_word : near; // s16.15
    wire signed [16:0] difference_70 = {{1{words_word[15]}}, words_word} - {{1{near[15]}}, near}; // s17.15
    wire signed [18:0] choice_72 =
        ((step == 3'd3) & bit_59) ? {{2{difference_70[16]}}, difference_70}
        : difference; // s19.0
    wire signed [33:0] product_74 = difference * $signed({1'b0, factor}); // s34.0
    wire signed [33:0] choice_75 = (step == 3'd4) ? product_74 : product; // s34.0
    wire step_is_coordinate = step == 3'd0; // u1.0
    wire operation_is_middle_y = operation == 5'd2; // u1.0
    wire operation_is_stretch_y = operation == 5'd3; // u1.0
    wire bit_79 = operation_is_middle_y | operation_is_stretch_y; // u1.0
    wire signed [15:0] choice_80 = bit_79 ? p_x : v; // s16.15
    wire signed [17:0] sum_81 = {{2{choice_80[15]}}, choice_80} + 18'd32768; // s18.15
    wire [15:0] fit_82 = sum_81[15:0]; // u16.15
    wire signed [16:0] difference_85 = {1'd0, fit_82} - {1'd0, fit_82[15:10], 10'd0}; // s17.10
    wire operation_is_spacing_y = operation == 5'd5; // u1.0
    wire signed [15:0] choice_88 = operation_is_spacing_y ? v : u; // s16.15
    wire signed [17:0] sum_89 = {{2{choice_88[15]}}, choice_88} + 18'd32768; // s18.15
    wire [15:0] fit_90 = sum_89[15:0]; // u16.15
    wire signed [16:0] difference_93 = {1'd0, fit_90} - {1'd0, fit_90[15:9], 9'd0}; // s17.9
    wire operation_is_middle_x = operation == 5'd6; // u1.0
    wire operation_is_spacing_x = operation == 5'd9; // u1.0
    wire bit_108 = operation_is_spacing_y | operation_is_spacing_x; // u1.0
    wire [8:0] sum_110 = {1'd0, bit_79 ? {1'd0, operation_is_middle_y ? 7'd0 : 7'd65} : operation_is_middle_x ? 8'd130 : 8'd195} + {3'd0, fit_82[15:10]}; // u9.0
    wire signed [17:0] sum_112 = {{2{u[15]}}, u} + 18'd32768; // s18.15
    wire [15:0] fit_113 = sum_112[15:0]; // u16.15
    wire signed [16:0] difference_116 = {1'd0, fit_113} - {1'd0, fit_113[15:12], 12'd0}; // s17.12
    wire signed [17:0] sum_118 = {{2{v[15]}}, v} + 18'd32768; // s18.15
    wire [15:0] fit_119 = sum_118[15:0]; // u16.15
    wire signed [16:0] difference_122 = {1'd0, fit_119} - {1'd0, fit_119[15:12], 12'd0}; // s17.12
    wire bit_131 = ((operation == 5'd11) | (operation == 5'd14)) | (operation == 5'd17); // u1.0
    wire [4:0] sum_132 = {1'd0, fit_119[15:12]} + {4'd0, bit_131}; // u5.0
    wire [11:0] sum_147 = {1'd0, (~(operation < 5'd16)) ? 11'd1096 : {1'd0, (~(operation < 5'd13)) ? 10'd807 : 10'd518}} + {2'd0, {1'd0, {sum_132, 4'd0}} + {5'd0, sum_132}}; // u12.0
    wire bit_152 = ~(operation < 5'd10); // u1.0
    wire [12:0] choice_155 =
        bit_152 ? ({1'd0, sum_147} + {9'd0, fit_113[15:12]})
        : {3'd0, bit_108 ? ({1'd0, operation_is_spacing_y ? 9'd260
        : 9'd389} + {3'd0, fit_90[15:9]})
        : {1'd0, sum_110}}; // u13.0
    wire signed [17:0] choice_157 = operation_is_box_x ? r_x : r_y; // s18.16
    wire signed [17:0] choice_158 = operation_is_box_x ? origin_x : origin_y; // s18.16
    wire signed [15:0] choice_160 = operation_is_straighten_y ? p_y : p_x; // s16.15
    wire signed [16:0] choice_167 =
        bit_48 ? ({{1{choice_160[15]}}, choice_160} - {{1{middle[15]}}, middle})
        : ({{1{below[15]}}, below} - {{1{above[15]}}, above}); // s17.0
    wire signed [23:0] fit_177 = {choice_75[33], choice_75[33:11]} + {23'd0, choice_75[10] & (choice_75[11] | (|choice_75[9:0]))}; // s24.15
    wire signed [15:0] fit_178 =
        (fit_177[23:15] == {9{fit_177[23]}}) ? fit_177[15:0] : {fit_177[23], {15{~fit_177[23]}}}; // s16.15
    wire signed [31:0] fit_181 = choice_75[31:0]; // s32.0
    wire signed [22:0] fit_184 = {fit_181[31], fit_181[31:10]} + {22'd0, fit_181[9] & (fit_181[10] | (|fit_181[8:0]))}; // s23.15
    wire signed [15:0] fit_185 =
        (fit_184[22:15] == {8{fit_184[22]}}) ? fit_184[15:0] : {fit_184[22], {15{~fit_184[22]}}}; // s16.15
    wire signed [28:0] fit_188 = choice_75[28:0]; // s29.0
    wire signed [29:0] sum_190 = {{2{choice_66[15]}}, choice_66, 12'd0} + {{1{fit_188[28]}}, fit_188}; // s30.27
    wire signed [18:0] fit_191 = {sum_190[29], sum_190[29:12]} + {18'd0, sum_190[11] & (sum_190[12] | (|sum_190[10:0]))}; // s19.15
    wire signed [15:0] fit_192 =
        (fit_191[18:15] == {4{fit_191[18]}}) ? fit_191[15:0] : {fit_191[18], {15{~fit_191[18]}}}; // s16.15
    wire signed [15:0] choice_196 = bit_43 ? fit_178 : bit_48 ? fit_185 : fit_192; // s16.15
    wire [5:0] choice_202 = operation_is_r ? 6'd0 : ({1'd0, operation} + 6'd1); // u6.0
    wire bit_227 = saturated | (bit_43 ? (~({{8{fit_178[15]}}, fit_178} == fit_177)) : bit_48 ? (~({{7{fit_185[15]}}, fit_185} == fit_184)) : (~({{3{fit_192[15]}}, fit_192} == fit_191))); // u1.0

    initial begin : initial_words
        integer i;
        for (i = 0; i < 1385; i = i + 1) words[i] = 16'd0;
    end

    always @(posedge clock) begin
        if (write) words[address] <= word;
        words_word <= words[sum_37[10:0]];
    end

    always @(posedge clock) begin
        if (reset) begin
            busy <= 1'd0;
            operation <= 5'd0;
            step <= 3'd0;
            p_x <= 16'd0;
            p_y <= 16'd0;
            middle <= 16'd0;
            stretch <= 16'd0;
            u <= 16'd0;
            v <= 16'd0;
            above <= 16'd0;
            below <= 16'd0;
            base <= 11'd0;
            near <= 16'd0;
            difference <= 19'd0;
            factor <= 15'd0;
            product <= 34'd0;
            x <= 16'd0;
            y <= 16'd0;
            sheet <= 15'd0;
            saturated <= 1'd0;
            done <= 1'd0;
        end else begin
            if (start) begin
                busy <= 1'd1;
                operation <= 5'd0;
                step <= 3'd0;
                saturated <= 1'd0;
                done <= 1'd0;
            end else if (busy) begin
                if (step_is_coordinate) begin
                    step <= choice_63[2:0];
                    base <= choice_155[10:0];
                    near <= bit_57 ? above : choice_66;
                    product <= choice_75;
                    done <= 1'd0;
                    if (bit_43) begin
                        difference <= {{1{choice_157[17]}}, choice_157} - {{1{choice_158[17]}}, choice_158};
                        factor <= operation_is_box_x ? scale_x : scale_y;
                    end else begin
                        difference <= {{2{choice_167[16]}}, choice_167};
                        factor <=
                            bit_48 ? (stretch[15] ? 15'd0 : stretch[14:0])
                            : {3'd0, bit_152 ? (bit_57 ? difference_122[11:0]
                            : difference_116[11:0])
                            : bit_108 ? {difference_93[8:0], 3'd0}
                            : {difference_85[9:0], 2'd0}};
                    end
                end else if (step_is_finish) begin
                    busy <= ~operation_is_r;
                    operation <= choice_202[4:0];
                    step <= choice_63[2:0];
                    near <= choice_66;
                    difference <= choice_72;
                    product <= choice_75;
                    saturated <= bit_227;
                    done <= operation_is_r;
                    if (operation_is_r) begin
                        sheet <= choice_196[15] ? 15'd0 : choice_196[14:0];
                    end
                    if (operation_is_y) begin
                        y <= choice_196;
                    end
                    if (operation_is_x) begin
                        x <= choice_196;
                    end
                    if (bit_131) begin
                        below <= choice_196;
                    end
                    if (((operation == 5'd10) | (operation == 5'd13)) | (operation == 5'd16)) begin
                        above <= choice_196;
                    end
                    if (operation_is_straighten_y | operation_is_spacing_y) begin
                        v <= choice_196;
                    end
                    if (operation_is_straighten_x | operation_is_spacing_x) begin
                        u <= choice_196;
                    end
                    if (operation_is_stretch_y | (operation == 5'd7)) begin
                        stretch <= choice_196;
                    end
                    if (operation_is_middle_y | operation_is_middle_x) begin
                        middle <= choice_196;
                    end
                    if (operation_is_box_y) begin
                        p_y <= choice_196;
                    end
                    if (operation_is_box_x) begin
                        p_x <= choice_196;
                    end
                end else begin
                    step <= choice_63[2:0];
                    near <= choice_66;
                    difference <= choice_72;
                    product <= choice_75;
                    done <= 1'd0;
                end
            end else begin
                done <= 1'd0;
            end
        end
    end

    // What nothing needs.
    wire unused = &{1'b0, sum_37[11], choice_63[3], sum_81[17:16], difference_85[16:10], sum_89[17:16],
        difference_93[16:9], sum_112[17:16], difference_116[16:12], sum_118[17:16], difference_122[16:12],
        choice_155[12:11], choice_202[5]};

endmodule

`default_nettype wire
