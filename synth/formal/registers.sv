// SPDX-License-Identifier: MIT OR Apache-2.0
// Registers: a command acts only if all its bytes have come, with links and CRC that are right, and then on nothing but the
// register or the word that it names. Commands are taken apart here once more, the CRC a bit at a time.
//
// Appended to the printed module; parameters: DATA (bytes of a command's data), WORDS (of the table), ADDRESS (its bits), and the
// registers' numbers: CAPACITANCE, FORCE, CONTACT, CONTROL and ADC, of REGISTERS.

    // Bytes on the line before END, and bits of place and data.
    localparam LENGTH = DATA + 7;
    localparam WHOLE = 8 * (DATA + 2);
    localparam TABLE = REGISTERS, NONE = REGISTERS + 1;

    function [31:0] check_of(input [31:0] before, input [7:0] next);
        integer k;
        begin
            check_of = before;
            for (k = 0; k < 8; k = k + 1)
                check_of = {1'b0, check_of[31:1]} ^ ((check_of[0] ^ next[k]) ? 32'hedb88320 : 32'h00000000);
        end
    endfunction

    reg was_reset = 0;
    always @(posedge clock) was_reset <= 1;
    always @(*) if (!was_reset) assume (reset);

    // The command as it comes: how many bytes, how many until the next link, and what they are.
    reg [4:0] length = 0;
    reg [7:0] until = 0;
    reg [31:0] check = 0;
    reg [WHOLE-1:0] whole = 0;
    // A link leads further than a command has bytes.
    reg far = 0;
    wire end_byte = octet == 0;
    wire link = until == 0;
    wire [7:0] plain = link ? 0 : octet;
    wire taken = valid && !end_byte;
    always @(posedge clock) begin
        if (reset || (valid && end_byte)) begin
            length <= 0;
            until <= 0;
            far <= 0;
        end else if (taken) begin
            if (length != 31) length <= length + 1;
            until <= (link ? octet : until) - 1;
            far <= far || (link && octet > 15);
            check <= length == 0 ? 32'hffffffff : check_of(check, plain);
            if (length != 0 && length < LENGTH - 4) whole <= {whole[WHOLE-9:0], plain};
        end
    end

    // At its END: whether it counts, and what it writes.
    reg counts = 0, refuses = 0;
    reg [15:0] where = 0;
    reg [8*DATA-1:0] what = 0;
    // With the complement of the CRC behind them, bytes have this CRC, whatever they are.
    wire whole_and_right = length == LENGTH && until == 0 && check == 32'hdebb20e3;
    wire for_adc = whole[WHOLE-1] && whole[WHOLE-14:WHOLE-16] == ADC;
    // The command before may still be enabling the board.
    // A test of a line converts, too.
    wire enabled = counts && where[15] && where[2:0] == CONTROL ? what[0] || what[2] : enable || control[2];
    always @(posedge clock) begin
        counts <= !reset && valid && end_byte && whole_and_right && !(for_adc && enabled);
        refuses <= !reset && valid && end_byte && length != 0
            && !(whole_and_right && !(for_adc && enabled));
        {where, what} <= whole;
    end
    wire [ADDRESS-1:0] at = where[ADDRESS-1:0];
    wire [2:0] target = !counts ? NONE : where[15] ? (where[2:0] < REGISTERS ? where[2:0] : NONE) : at < WORDS ? TABLE : NONE;

    // The ADC reader moves data on between commands only: its word is shorter than the bytes of the next.
    wire packet = length != 0;
    always @(*) if (was_reset) assume (!(shift && (packet || valid)));

    reg past_valid = 0;
    reg [2:0] past_target = NONE;
    reg [8*DATA-1:0] past_what = 0;
    reg [$bits(capacitance_gain)-1:0] before_capacitance = 0;
    reg [$bits(force_gain)-1:0] before_force = 0;
    reg [$bits(contact_capacitance)-1:0] before_contact = 0;
    reg [5:0] before_control = 0;
    reg [3:0] before_commands = 0;
    wire [5:0] control_now = control;
    always @(posedge clock) begin
        past_valid <= was_reset && !reset;
        past_target <= target;
        past_what <= what;
        before_capacitance <= capacitance_gain;
        before_force <= force_gain;
        before_contact <= contact_capacitance;
        before_control <= control_now;
        before_commands <= commands;
    end

    // Bits of place and data that this command's bytes have filled.
    wire [4:0] kept = length == 0 ? 0 : length < LENGTH - 4 ? length - 1 : LENGTH - 5;
    wire [WHOLE-1:0] open = {WHOLE{1'b1}} << (8 * kept);

    always @(posedge clock) if (was_reset) begin
        // Invariants.
        assert (count == (far || length > LENGTH ? LENGTH + 1 : length));
        if (length == 0) assert (!far && until == 0);
        if (far && length <= LENGTH) assert (until + length > 15);
        if (!far) assert (left == until);
        if (!far && length != 0 && length <= LENGTH) assert (crc == check);
        if (!far) assert ((({place_q, data} ^ whole) & ~open) == 0);
        if (counts) assert ({place_q, data} == {where, what});
        // Properties. A command acts if it counts, and in the clock after its END.
        assert (act == counts);
        assert (refused == refuses);
        assert (write == (target == TABLE));
        if (write) assert (address == at && word == $signed(what[$bits(word)-1:0]));
        assert (adc_write == (target == ADC));
        assert (!(adc_write && (enable || line_test)));
        assert (written == (counts && where[15] && where[2:0] != CONTROL));
        assert (controlled == (target == CONTROL));
        // A test of a line and a measurement exclude each other.
        assert ({line, adc_reset, enable} == {control[5:3], control[1:0]} && line_test == (control[2] && !enable));
        // Each register has what was written into it, and nothing else changes it.
        if (past_valid) begin
            assert (capacitance_gain == (past_target == CAPACITANCE ? past_what[$bits(capacitance_gain)-1:0] : before_capacitance));
            assert (force_gain == (past_target == FORCE ? past_what[$bits(force_gain)-1:0] : before_force));
            assert (contact_capacitance == (past_target == CONTACT ? past_what[$bits(contact_capacitance)-1:0] : before_contact));
            assert (control_now == (past_target == CONTROL ? past_what[5:0] : before_control));
            assert (commands == before_commands + counts);
        end
    end

    // Cover: the properties are not vacuous.
    always @(posedge clock) if (was_reset) begin
        cover (target == CAPACITANCE);
        cover (target == FORCE && what != 0);
        cover (target == CONTACT && what != 0);
        cover (target == CONTROL && what[1:0] == 1);
        cover (target == CONTROL && what[2:0] == 4);
        cover (adc_write);
        cover (write && address == WORDS - 1);
        cover (counts && target == NONE);
        cover (refused);
    end
