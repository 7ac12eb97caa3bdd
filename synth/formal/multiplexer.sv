// SPDX-License-Identifier: MIT OR Apache-2.0
// Multiplexer: at most one pad is ever selected, and between two pads none is, for OPEN samples at least; every pad gets its
// turn in order; for all times at which samples may come and slots be abandoned. Abandoning one is a reset but for the pads:
// whoever drives them after it must keep a break of its own, as the boards' pad selection does.
//
// Appended to the printed module; parameters: OPEN, BEGIN, SLOT (samples) and PADS.

    reg was_reset = 0;
    reg past_strobe;
    reg past_valid = 0;
    reg [31:0] open_for;
    reg [PADS-1:0] before;
    reg [PADS-1:0] driven;
    wire [PADS-1:0] select = closed ? 1 << pad : 0;
    always @(posedge clock) begin
        was_reset <= 1;
        past_valid <= !reset && !clear;
        past_strobe <= strobe;
        before <= reset || clear ? 0 : select;
        // The pad that was selected last, and for how many samples none has been since.
        if (reset || clear) begin
            driven <= 0;
            open_for <= 0;
        end else if (select != 0) begin
            driven <= select;
            open_for <= 0;
        end else if (sample && open_for < OPEN) begin
            open_for <= open_for + 1;
        end
    end
    always @(*) if (!was_reset) assume (reset);

    always @(posedge clock) if (was_reset) begin
        // Invariants: the position of the next sample.
        assert (count < SLOT && next < PADS && pad < PADS);
        assert (!closed || count == 0 || count > OPEN);
        assert (!closed || count == 0 || pad == next);
        assert (!closed || count != 0 || next == (pad == PADS - 1 ? 0 : pad + 1));
        assert (closed || count <= OPEN);
        assert (closed || driven == 0 || driven == 1 << (next == 0 ? PADS - 1 : next - 1));
        assert (!closed || driven == 0 || driven == select || open_for == OPEN);
        assert (closed || driven == 0 || count == 0 || open_for + sample == count);
        assert (closed || driven == 0 || count != 0);
        assert (open_for <= OPEN);
        // Properties.
        assert ((select & (select - 1'b1)) == 0);
        if (before != 0) assert (select == before || select == 0);
        if (before == 0 && select != 0) assert (driven == 0 || open_for == OPEN);
        if (closed && driven != 0) assert (driven == select || driven == 1 << (pad == 0 ? PADS - 1 : pad - 1));
        // What each sample is for: of a slot, and of its window, the first and last.
        if (sample) begin
            assert (restart == (count == 1));
            assert (closed == (count == 0 || count > OPEN));
            assert (integrate == (count == 0 || count > BEGIN));
            assert (first == (count == BEGIN + 1 || (BEGIN + 1 == SLOT && count == 0)));
            assert (last == (count == 0));
        end
        // A sample for each strobe, in the clock after it.
        if (past_valid) assert (sample == past_strobe);
        // Nobody listens to a pad that is not selected, nor before it has settled.
        if (sample && integrate) assert (closed);
        if (sample && first) assert (integrate);
        assert (!(restart && closed));
    end
