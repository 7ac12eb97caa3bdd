// SPDX-License-Identifier: MIT OR Apache-2.0
// What two ECP5 cells do that Yosys knows by name only: block RAM and multiplier, in the modes that Yosys 0.70 makes of
// our Verilog. Anything else stops the simulation with a message, so that no netlist passes for a reason of ours.
//
// Sources: Lattice FPGA-TN-02204 (memory), FPGA-TN-02205 (sysDSP), and how Yosys connects them: techlibs/lattice
// brams_map_16kd.v, dsp_map_18x18.v.

module MULT18X18D (
    input A17, A16, A15, A14, A13, A12, A11, A10, A9, A8, A7, A6, A5, A4, A3, A2, A1, A0, B17, B16, B15, B14, B13,
    B12, B11, B10, B9, B8, B7, B6, B5, B4, B3, B2, B1, B0, C17, C16, C15, C14, C13, C12, C11, C10, C9, C8, C7, C6,
    C5, C4, C3, C2, C1, C0,
    input SIGNEDA, SIGNEDB, SOURCEA, SOURCEB, CLK0, CLK1, CLK2, CLK3, CE0, CE1, CE2, CE3, RST0, RST1, RST2, RST3,
    output P35, P34, P33, P32, P31, P30, P29, P28, P27, P26, P25, P24, P23, P22, P21, P20, P19, P18, P17, P16, P15,
    P14, P13, P12, P11, P10, P9, P8, P7, P6, P5, P4, P3, P2, P1, P0
);
    parameter REG_INPUTA_CLK = "NONE";
    parameter REG_INPUTB_CLK = "NONE";
    parameter REG_INPUTC_CLK = "NONE";
    parameter REG_PIPELINE_CLK = "NONE";
    parameter REG_OUTPUT_CLK = "NONE";
    parameter MULT_BYPASS = "DISABLED";
    initial begin
        if (REG_INPUTA_CLK != "NONE" || REG_INPUTB_CLK != "NONE" || REG_INPUTC_CLK != "NONE" ||
            REG_PIPELINE_CLK != "NONE" || REG_OUTPUT_CLK != "NONE" || MULT_BYPASS != "DISABLED") begin
            $display("MULT18X18D: this model has no registers within and no bypass");
            $fatal(1);
        end
    end
    // Each operand with a sign bit of its own, which is zero where the operand is unsigned.
    wire signed [18:0] a = {SIGNEDA & A17,
        A17, A16, A15, A14, A13, A12, A11, A10, A9, A8, A7, A6, A5, A4, A3, A2, A1, A0};
    wire signed [18:0] b = {SIGNEDB & B17,
        B17, B16, B15, B14, B13, B12, B11, B10, B9, B8, B7, B6, B5, B4, B3, B2, B1, B0};
    wire signed [37:0] product = a * b;
    assign {P35, P34, P33, P32, P31, P30, P29, P28, P27, P26, P25, P24, P23, P22, P21, P20, P19, P18, P17, P16,
        P15, P14, P13, P12, P11, P10, P9, P8, P7, P6, P5, P4, P3, P2, P1, P0} = product[35:0];
endmodule

// Cells of nine bits; a port of 1, 2 or 4 bits uses eight of the nine. Port widths 36 (A writes, B reads) or at most 18.
module DP16KD (
    input DIA17, DIA16, DIA15, DIA14, DIA13, DIA12, DIA11, DIA10, DIA9, DIA8, DIA7, DIA6, DIA5, DIA4, DIA3, DIA2,
    DIA1, DIA0, ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0,
    input CEA, OCEA, CLKA, WEA, RSTA, CSA2, CSA1, CSA0,
    output DOA17, DOA16, DOA15, DOA14, DOA13, DOA12, DOA11, DOA10, DOA9, DOA8, DOA7, DOA6, DOA5, DOA4, DOA3, DOA2,
    DOA1, DOA0,
    input DIB17, DIB16, DIB15, DIB14, DIB13, DIB12, DIB11, DIB10, DIB9, DIB8, DIB7, DIB6, DIB5, DIB4, DIB3, DIB2,
    DIB1, DIB0, ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0,
    input CEB, OCEB, CLKB, WEB, RSTB, CSB2, CSB1, CSB0,
    output DOB17, DOB16, DOB15, DOB14, DOB13, DOB12, DOB11, DOB10, DOB9, DOB8, DOB7, DOB6, DOB5, DOB4, DOB3, DOB2,
    DOB1, DOB0
);
    parameter DATA_WIDTH_A = 18;
    parameter DATA_WIDTH_B = 18;
    parameter REGMODE_A = "NOREG";
    parameter REGMODE_B = "NOREG";
    parameter RESETMODE = "SYNC";
    parameter ASYNC_RESET_RELEASE = "SYNC";
    parameter CSDECODE_A = "0b000";
    parameter CSDECODE_B = "0b000";
    parameter WRITEMODE_A = "NORMAL";
    parameter WRITEMODE_B = "NORMAL";
    parameter CLKAMUX = "CLKA";
    parameter CLKBMUX = "CLKB";
    parameter GSR = "DISABLED";
    parameter [319:0] INITVAL_00 = 320'h0;
    parameter [319:0] INITVAL_01 = 320'h0;
    parameter [319:0] INITVAL_02 = 320'h0;
    parameter [319:0] INITVAL_03 = 320'h0;
    parameter [319:0] INITVAL_04 = 320'h0;
    parameter [319:0] INITVAL_05 = 320'h0;
    parameter [319:0] INITVAL_06 = 320'h0;
    parameter [319:0] INITVAL_07 = 320'h0;
    parameter [319:0] INITVAL_08 = 320'h0;
    parameter [319:0] INITVAL_09 = 320'h0;
    parameter [319:0] INITVAL_0A = 320'h0;
    parameter [319:0] INITVAL_0B = 320'h0;
    parameter [319:0] INITVAL_0C = 320'h0;
    parameter [319:0] INITVAL_0D = 320'h0;
    parameter [319:0] INITVAL_0E = 320'h0;
    parameter [319:0] INITVAL_0F = 320'h0;
    parameter [319:0] INITVAL_10 = 320'h0;
    parameter [319:0] INITVAL_11 = 320'h0;
    parameter [319:0] INITVAL_12 = 320'h0;
    parameter [319:0] INITVAL_13 = 320'h0;
    parameter [319:0] INITVAL_14 = 320'h0;
    parameter [319:0] INITVAL_15 = 320'h0;
    parameter [319:0] INITVAL_16 = 320'h0;
    parameter [319:0] INITVAL_17 = 320'h0;
    parameter [319:0] INITVAL_18 = 320'h0;
    parameter [319:0] INITVAL_19 = 320'h0;
    parameter [319:0] INITVAL_1A = 320'h0;
    parameter [319:0] INITVAL_1B = 320'h0;
    parameter [319:0] INITVAL_1C = 320'h0;
    parameter [319:0] INITVAL_1D = 320'h0;
    parameter [319:0] INITVAL_1E = 320'h0;
    parameter [319:0] INITVAL_1F = 320'h0;
    parameter [319:0] INITVAL_20 = 320'h0;
    parameter [319:0] INITVAL_21 = 320'h0;
    parameter [319:0] INITVAL_22 = 320'h0;
    parameter [319:0] INITVAL_23 = 320'h0;
    parameter [319:0] INITVAL_24 = 320'h0;
    parameter [319:0] INITVAL_25 = 320'h0;
    parameter [319:0] INITVAL_26 = 320'h0;
    parameter [319:0] INITVAL_27 = 320'h0;
    parameter [319:0] INITVAL_28 = 320'h0;
    parameter [319:0] INITVAL_29 = 320'h0;
    parameter [319:0] INITVAL_2A = 320'h0;
    parameter [319:0] INITVAL_2B = 320'h0;
    parameter [319:0] INITVAL_2C = 320'h0;
    parameter [319:0] INITVAL_2D = 320'h0;
    parameter [319:0] INITVAL_2E = 320'h0;
    parameter [319:0] INITVAL_2F = 320'h0;
    parameter [319:0] INITVAL_30 = 320'h0;
    parameter [319:0] INITVAL_31 = 320'h0;
    parameter [319:0] INITVAL_32 = 320'h0;
    parameter [319:0] INITVAL_33 = 320'h0;
    parameter [319:0] INITVAL_34 = 320'h0;
    parameter [319:0] INITVAL_35 = 320'h0;
    parameter [319:0] INITVAL_36 = 320'h0;
    parameter [319:0] INITVAL_37 = 320'h0;
    parameter [319:0] INITVAL_38 = 320'h0;
    parameter [319:0] INITVAL_39 = 320'h0;
    parameter [319:0] INITVAL_3A = 320'h0;
    parameter [319:0] INITVAL_3B = 320'h0;
    parameter [319:0] INITVAL_3C = 320'h0;
    parameter [319:0] INITVAL_3D = 320'h0;
    parameter [319:0] INITVAL_3E = 320'h0;
    parameter [319:0] INITVAL_3F = 320'h0;

    reg [8:0] cells [0:2047];
    reg [35:0] read_a, read_b;

    localparam WIDE = DATA_WIDTH_A == 36 || DATA_WIDTH_B == 36;

    // Sixteen words of 18 bits to an INITVAL, each in 20 bits.
    task fill(input integer block, input [319:0] words);
        integer word;
        for (word = 0; word < 16; word = word + 1) begin
            cells[32 * block + 2 * word] = words[20 * word +: 9];
            cells[32 * block + 2 * word + 1] = words[20 * word + 9 +: 9];
        end
    endtask

    initial begin
        if (REGMODE_A != "NOREG" || REGMODE_B != "NOREG") begin
            $display("DP16KD: this model has no output registers");
            $fatal(1);
        end
        if (CLKAMUX != "CLKA" || CLKBMUX != "CLKB" || CSDECODE_A != "0b000" || CSDECODE_B != "0b000") begin
            $display("DP16KD: this model has rising clocks and is always selected");
            $fatal(1);
        end
        if ((WIDE && DATA_WIDTH_A > 36) || (!WIDE && (DATA_WIDTH_A > 18 || DATA_WIDTH_B > 18))) begin
            $display("DP16KD: widths %0d and %0d", DATA_WIDTH_A, DATA_WIDTH_B);
            $fatal(1);
        end
        read_a = 36'd0;
        read_b = 36'd0;
        fill(0, INITVAL_00);
        fill(1, INITVAL_01);
        fill(2, INITVAL_02);
        fill(3, INITVAL_03);
        fill(4, INITVAL_04);
        fill(5, INITVAL_05);
        fill(6, INITVAL_06);
        fill(7, INITVAL_07);
        fill(8, INITVAL_08);
        fill(9, INITVAL_09);
        fill(10, INITVAL_0A);
        fill(11, INITVAL_0B);
        fill(12, INITVAL_0C);
        fill(13, INITVAL_0D);
        fill(14, INITVAL_0E);
        fill(15, INITVAL_0F);
        fill(16, INITVAL_10);
        fill(17, INITVAL_11);
        fill(18, INITVAL_12);
        fill(19, INITVAL_13);
        fill(20, INITVAL_14);
        fill(21, INITVAL_15);
        fill(22, INITVAL_16);
        fill(23, INITVAL_17);
        fill(24, INITVAL_18);
        fill(25, INITVAL_19);
        fill(26, INITVAL_1A);
        fill(27, INITVAL_1B);
        fill(28, INITVAL_1C);
        fill(29, INITVAL_1D);
        fill(30, INITVAL_1E);
        fill(31, INITVAL_1F);
        fill(32, INITVAL_20);
        fill(33, INITVAL_21);
        fill(34, INITVAL_22);
        fill(35, INITVAL_23);
        fill(36, INITVAL_24);
        fill(37, INITVAL_25);
        fill(38, INITVAL_26);
        fill(39, INITVAL_27);
        fill(40, INITVAL_28);
        fill(41, INITVAL_29);
        fill(42, INITVAL_2A);
        fill(43, INITVAL_2B);
        fill(44, INITVAL_2C);
        fill(45, INITVAL_2D);
        fill(46, INITVAL_2E);
        fill(47, INITVAL_2F);
        fill(48, INITVAL_30);
        fill(49, INITVAL_31);
        fill(50, INITVAL_32);
        fill(51, INITVAL_33);
        fill(52, INITVAL_34);
        fill(53, INITVAL_35);
        fill(54, INITVAL_36);
        fill(55, INITVAL_37);
        fill(56, INITVAL_38);
        fill(57, INITVAL_39);
        fill(58, INITVAL_3A);
        fill(59, INITVAL_3B);
        fill(60, INITVAL_3C);
        fill(61, INITVAL_3D);
        fill(62, INITVAL_3E);
        fill(63, INITVAL_3F);
    end

    wire [13:0] address_a = {ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0};
    wire [13:0] address_b = {ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0};
    wire [17:0] data_a = {DIA17, DIA16, DIA15, DIA14, DIA13, DIA12, DIA11, DIA10, DIA9, DIA8, DIA7, DIA6, DIA5, DIA4, DIA3, DIA2,
        DIA1, DIA0};
    wire [17:0] data_b = {DIB17, DIB16, DIB15, DIB14, DIB13, DIB12, DIB11, DIB10, DIB9, DIB8, DIB7, DIB6, DIB5, DIB4, DIB3, DIB2,
        DIB1, DIB0};

    wire selected_a = CEA && {CSA2, CSA1, CSA0} === 3'd0;
    wire selected_b = CEB && {CSB2, CSB1, CSB0} === 3'd0;

    // Whether a port that writes at an address writes this cell.
    function writes(input integer width, input [13:0] address, input [10:0] at);
        case (width)
            36: writes = address[13:5] == at[10:2] && address[{2'd0, at[1:0]}];
            18: writes = address[13:4] == at[10:1] && address[{3'd0, at[0]}];
            default: writes = address[13:3] == at;
        endcase
    endfunction

    // How many low address bits lie within what the wider of two ports below nine bits takes at once.
    function integer part(input integer widths);
        part = widths >= 4 ? 2 : widths >= 2 ? 1 : 0;
    endfunction

    // A cell as the other port sees it. What a cell reads while it is written from there is undefined in hardware: here
    // every bit is wrong, so that a netlist that depends on it is found out.
    function [8:0] seen(input [10:0] at, input written);
        seen = written ? ~cells[at] : cells[at];
    endfunction

    // What a port of a width reads at an address, with the width and address of the port that writes meanwhile.
    function [35:0] word(
        input integer width, input [13:0] address, input other, input integer other_width, input [13:0] other_address
    );
        integer k;
        reg [10:0] at;
        reg [8:0] cell_read;
        reg meet;
        begin
            word = 36'd0;
            case (width)
                36: for (k = 0; k < 4; k = k + 1) begin
                    at = {address[13:5], k[1:0]};
                    word[9 * k +: 9] = seen(at, other && writes(other_width, other_address, at));
                end
                18: for (k = 0; k < 2; k = k + 1) begin
                    at = {address[13:4], k[0]};
                    word[9 * k +: 9] = seen(at, other && writes(other_width, other_address, at));
                end
                default: begin
                    at = address[13:3];
                    // Parts of one cell of nine bits are apart.
                    if (width < 9 && other_width < 9)
                        meet = address >> part(width | other_width) == other_address >> part(width | other_width);
                    else meet = writes(other_width, other_address, at);
                    cell_read = seen(at, other && meet);
                    case (width)
                        9: word[8:0] = cell_read;
                        4: word[3:0] = cell_read[{1'b0, address[2], 2'd0} +: 4];
                        2: word[1:0] = cell_read[{1'b0, address[2:1], 1'b0} +: 2];
                        default: word[0] = cell_read[{1'b0, address[2:0]}];
                    endcase
                end
            endcase
        end
    endfunction

    // Byte enables are the low address bits of ports of 18 bits and more.
    task write(input integer width, input [13:0] address, input [35:0] data);
        case (width)
            36: begin
                if (address[0]) cells[{address[13:5], 2'd0}] <= data[8:0];
                if (address[1]) cells[{address[13:5], 2'd1}] <= data[17:9];
                if (address[2]) cells[{address[13:5], 2'd2}] <= data[26:18];
                if (address[3]) cells[{address[13:5], 2'd3}] <= data[35:27];
            end
            18: begin
                if (address[0]) cells[{address[13:4], 1'b0}] <= data[8:0];
                if (address[1]) cells[{address[13:4], 1'b1}] <= data[17:9];
            end
            9: cells[address[13:3]] <= data[8:0];
            4: cells[address[13:3]][{1'b0, address[2], 2'd0} +: 4] <= data[3:0];
            2: cells[address[13:3]][{1'b0, address[2:1], 1'b0} +: 2] <= data[1:0];
            default: cells[address[13:3]][{1'b0, address[2:0]}] <= data[0];
        endcase
    endtask

    always @(posedge CLKA) begin
        if (selected_a && WEA) write(DATA_WIDTH_A, address_a, WIDE ? {data_b, data_a} : {18'd0, data_a});
        if (selected_a && (!WEA || WRITEMODE_A == "READBEFOREWRITE")) begin
            read_a <= word(DATA_WIDTH_A, address_a, selected_b && WEB, DATA_WIDTH_B, address_b);
        end
        if (RSTA) read_a <= 36'd0;
        if (selected_a && WEA && WRITEMODE_A == "WRITETHROUGH") begin
            $display("DP16KD: this model does not write through");
            $fatal(1);
        end
    end

    always @(posedge CLKB) begin
        if (selected_b && WEB) begin
            if (WIDE || WRITEMODE_B == "WRITETHROUGH") begin
                $display("DP16KD: port B of this model does not write wide, or through");
                $fatal(1);
            end
            write(DATA_WIDTH_B, address_b, {18'd0, data_b});
        end
        if (selected_b && (!WEB || WRITEMODE_B == "READBEFOREWRITE")) begin
            read_b <= word(DATA_WIDTH_B, address_b, selected_a && WEA, DATA_WIDTH_A, address_a);
        end
        if (RSTB) read_b <= 36'd0;
    end

    // A read port of 36 bits comes out of both; a narrower one beside a wide port out of B.
    wire [17:0] out_a = DATA_WIDTH_B == 36 ? read_b[17:0] : read_a[17:0];
    wire [17:0] out_b = DATA_WIDTH_B == 36 ? read_b[35:18] : read_b[17:0];
    assign {DOA17, DOA16, DOA15, DOA14, DOA13, DOA12, DOA11, DOA10, DOA9, DOA8, DOA7, DOA6, DOA5, DOA4, DOA3, DOA2,
        DOA1, DOA0} = out_a;
    assign {DOB17, DOB16, DOB15, DOB14, DOB13, DOB12, DOB11, DOB10, DOB9, DOB8, DOB7, DOB6, DOB5, DOB4, DOB3, DOB2,
        DOB1, DOB0} = out_b;
endmodule
