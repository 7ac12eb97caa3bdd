// SPDX-License-Identifier: MIT OR Apache-2.0
// Stream: what goes to the transmitter is whole packets, each with its CRC; END is at their ends and nowhere else, ESC only
// before what it may stand before; a frame is sent with the words that came with it, or dropped whole and told; a heartbeat
// whose words are written meanwhile ends early, and one that does not has each of its words whole.
//
// Appended to the printed module; parameters: BYTES (of a word), WIDTH (its bits) and
// `line`, what goes into the transmitter.

    localparam LENGTH = 3 + 8 * BYTES + 3;

    function [15:0] check_of(input [15:0] before, input [7:0] next);
        integer k;
        begin
            check_of = before;
            for (k = 7; k >= 0; k = k - 1)
                check_of = {check_of[14:0], 1'b0} ^ ((check_of[15] ^ next[k]) ? 16'h1021 : 16'h0000);
        end
    endfunction

    reg was_reset = 0;
    always @(posedge clock) was_reset <= 1;
    always @(*) if (!was_reset) assume (reset);

    // The words of a frame come one after the other, without a pause.
    reg [3:0] due = 0;
    always @(posedge clock) due <= reset ? 0 : valid ? (index == 7 ? 0 : due + 1) : due;
    always @(*) if (was_reset) begin
        assume (!valid || index == due);
        assume (valid || due == 0);
        assume (done == (valid && index == 7));
        // Frames are further apart than a packet's first byte takes, its number.
        assume (!(done && busy && group == 15 && left == 2));
    end

    // The bytes that go out: how many of a packet have gone, behind an ESC or not, and their CRC.
    wire sent = transmitter_taken;
    reg [7:0] at = 0;
    reg behind_esc = 0;
    reg [15:0] check = 16'hffff;
    wire end_byte = line == 8'hc0;
    wire esc_byte = line == 8'hdb;
    wire last = at == LENGTH - 1;
    wire [7:0] plain = !behind_esc ? line : line == 8'hdc ? 8'hc0 : 8'hdb;
    always @(posedge clock) begin
        if (reset) begin
            at <= 0;
            behind_esc <= 0;
            check <= 16'hffff;
        end else if (sent) begin
            behind_esc <= esc_byte;
            if (end_byte) begin
                at <= 0;
                check <= 16'hffff;
            end else if (!esc_byte) begin
                at <= at + 1;
                check <= check_of(check, plain);
            end
        end
    end

    // Any one word of a frame that is taken, and whether that frame is the one that is being sent.
    (* anyconst *) reg [2:0] which;
    reg [WIDTH-1:0] word = 0;
    reg accepted = 0, accepting = 0;
    reg before_busy = 0, before_end = 0, before_done = 0, before_idle = 0, past_valid = 0;
    reg [7:0] before_number = 0;
    reg before_sent = 0;
    // A word for heartbeats was written while one is being sent, which ends early.
    reg cut = 0;
    // The word of a heartbeat as it was when its first byte went.
    reg signed [WIDTH-1:0] begun = 0;
    always @(posedge clock) begin
        past_valid <= was_reset && !reset;
        before_busy <= busy;
        before_end <= sent && end_byte;
        before_done <= done;
        before_idle <= accepting || (valid && index == 0 && !busy);
        before_number <= number;
        before_sent <= sent;
        cut <= !reset && busy && heartbeat && (cut ? !sent : keep_q && !valid && group < 8);
        if (sent && group == which && left == BYTES - 1) begun <= words[{1'b1, which}];
        if (reset) begin
            accepting <= 0;
            accepted <= 0;
        end else begin
            if (valid && index == 0) accepting <= !busy;
            if (done) accepting <= 0;
            if (valid && index == which && (index == 0 ? !busy : accepting)) word <= frame;
            // A heartbeat begins only between frames.
            if (done && (accepting && due != 0)) accepted <= 1;
            else if (sent && end_byte) accepted <= 0;
        end
    end

    // The byte of the word that is due, as it lies in the memory.
    wire [3:0] place_in_memory = {heartbeat, group[2:0]};
    wire signed [WIDTH-1:0] stored = words[place_in_memory];
    wire [8*BYTES-1:0] stored_wide = {{8 * BYTES - WIDTH + 1{stored[WIDTH-1]}}, stored[WIDTH-2:0]};
    wire [8*BYTES-1:0] stored_moved = stored_wide >> (8 * left);
    wire number_special = number == 8'hc0 || number == 8'hdb;
    wire [7:0] second = {commands_q, 4'd0} | pad_q;
    wire stored_special = stored_moved[7:0] == 8'hc0 || stored_moved[7:0] == 8'hdb;

    // Where the packet stands, by group and bytes left.
    wire [7:0] place_of = group == 15 ? 2 - left : group == 8 ? 3 + 8 * BYTES + 2 - left : 3 + BYTES * group + BYTES - 1 - left;
    wire [8*BYTES-1:0] wide = {{8 * BYTES - WIDTH + 1{word[WIDTH-1]}}, word[WIDTH-2:0]};
    wire [8*BYTES-1:0] moved = wide >> (8 * left);

    wire [8*BYTES-1:0] begun_wide = {{8 * BYTES - WIDTH + 1{begun[WIDTH-1]}}, begun[WIDTH-2:0]};
    wire [8*BYTES-1:0] begun_moved = begun_wide >> (8 * left);

    always @(posedge clock) if (was_reset) begin
        // Invariants.
        if (cut) assert (busy && heartbeat && group == 8 && left == 0 && at < LENGTH - 2);
        if (busy && !cut) assert (at == place_of && group != 9 && group != 10 && group != 11 && group != 12 && group != 13 && group != 14);
        if (busy) assert (left < (group == 15 || group == 8 ? 3 : BYTES));
        if (!busy) assert (at == 0 && check == 16'hffff && !behind_esc);
        assert (escaped == behind_esc);
        assert (accepting == (due != 0 && taking));
        assert (!(accepting && busy));
        assert (accepted == (busy && !heartbeat));
        if (busy) assert (crc == check);
        if (busy && heartbeat) assert (saturated_q && !invalid_q && !lost_q);
        if (busy && group < 8 && !before_sent && !wrote) assert (words_word == stored);
        if (behind_esc && group < 8) assert (stored_special);
        if (behind_esc && group == 8 && !cut) assert (left != 0 && (crc[15:8] == 8'hc0 || crc[15:8] == 8'hdb));
        if (behind_esc && group == 15) assert (left == 2 ? number_special : left == 1 && (second == 8'hc0 || second == 8'hdb));
        if (busy && at == LENGTH - 2) assert (crc[7:0] == 0);
        if (busy && last) assert (check == 0);
        if (busy && heartbeat && group == which && left < BYTES - 1) assert (words[{1'b1, which}] == begun);
        if ((accepting && which < due) || accepted) assert (words[which] == word);
        // Properties.
        if (sent) begin
            assert (busy);
            assert (end_byte == (last || cut));
            if (behind_esc && !cut) assert (line == 8'hdc || line == 8'hdd);
            // The two bytes before END are the CRC: with them it is zero.
            if (last) assert (check == 0);
            if (accepted && group == which && !esc_byte) assert (plain == moved[7:0]);
            if (heartbeat && group == which && left < BYTES - 1 && !esc_byte) assert (plain == begun_moved[7:0]);
        end
        if (past_valid) begin
            // A packet that has begun ends with its END.
            assert (busy || !before_busy || before_end);
            // A frame counts, and is told where it is dropped.
            assert (number == before_number + before_done);
            if (before_done && !before_idle) assert (overrun);
            if (before_done && before_idle) assert (busy && at == 0 && !heartbeat);
        end
    end

    // Cover: the properties are not vacuous. (Whole packets of either kind, escapes, and frames that are dropped take thousands of
    // clocks: they happen in the lock-step of `tests/tests/board_faults.rs`.)
    always @(posedge clock) if (was_reset) begin
        cover (sent && accepted && word != 0);
        cover (busy && accepted && before_sent);
    end
