// SPDX-License-Identifier: MIT OR Apache-2.0
// Pad selection: at most one line is ever set, and between two of them none is for DEAD clocks at least; whatever the core
// says, at every clock.
//
// Appended to the printed module; parameters: PADS and DEAD.

    reg was_reset = 0;
    reg [PADS-1:0] before;
    reg [PADS-1:0] driven;
    reg [31:0] open_for;
    // The pad that is wanted, and for how many clocks it has been.
    wire [PADS-1:0] wanted = closed ? 1 << serve : 0;
    reg [PADS-1:0] wanted_before;
    reg [31:0] wanted_for = 0;
    always @(posedge clock) begin
        was_reset <= 1;
        before <= reset ? 0 : select;
        wanted_before <= wanted;
        if (reset || wanted == 0) wanted_for <= 0;
        else if (wanted_for == 0 || wanted != wanted_before) wanted_for <= 1;
        else if (wanted_for < DEAD + 2) wanted_for <= wanted_for + 1;
        if (reset) begin
            driven <= 0;
            open_for <= 0;
        end else if (select != 0) begin
            driven <= select;
            open_for <= 0;
        end else if (open_for < DEAD) begin
            open_for <= open_for + 1;
        end
    end
    always @(*) if (!was_reset) assume (reset);

    always @(posedge clock) if (was_reset) begin
        // Invariants.
        assert (open_for <= DEAD && dead <= DEAD);
        if (select == 0 && driven != 0 && open_for != 0) assert (dead + open_for >= DEAD);
        if (select == 0 && driven != 0 && open_for == 0) assert (dead == DEAD || dead == DEAD - 1 || before != 0);
        assert (wanted_for <= DEAD + 2);
        if (wanted_for != 0) assert (wanted_before != 0 && (select == wanted_before || (select == 0 && dead + wanted_for <= DEAD + 1)));
        // Properties.
        assert ((select & (select - 1'b1)) == 0);
        if (before != 0) assert (select == before || select == 0);
        if (select != 0 && driven != 0 && driven != select) assert (open_for >= DEAD);
        // A pad that is wanted for long enough is selected.
        if (wanted_for == DEAD + 2) assert (select == wanted_before);
    end
