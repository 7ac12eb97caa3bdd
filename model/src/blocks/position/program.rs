// SPDX-License-Identifier: MIT OR Apache-2.0
//! The position's program, and the words of its scratch memory.
//!
//! All words are fractions; `[·]` is a stored word, rounded to the nearest (halves upwards) and
//! saturated. A place u is in cells from the table's middle, by 32. The marks at the right say what
//! a line has made.

use super::instruction::{
    CHECK, COUNT, Index, Instruction, LOW, OPEN, Operation, SCALARS, SHARE, SURFACE, Slot, WRAP,
};
use Operation::{
    Base, End, Found, Input, Load, LoadCell, LoadDigit, LoadQuotient, Multiply, MultiplyTable,
    Output, Pass, Repeat, Set, Store, Surfaces,
};
use hapticore_contract::calibration::{Axis, Layout, Scalar, Surface};
use hapticore_hdl::format::Format;

/// The program of a profile.
#[derive(Debug, Clone)]
pub struct Program {
    /// Its instructions, in their order.
    pub instructions: Vec<Instruction>,
    digits: u8,
}

const fn at(slot: u8) -> Slot {
    Slot(slot, Index::None)
}

// Constants: powers of two for the digits of a quotient, then single ones, then those of a surface
// or axis.
const POWERS: Slot = at(0);
const HALF: Slot = at(16);
const LESS_HALF: Slot = at(17);
const LESS_ONE: Slot = at(18);
const QUARTER: Slot = at(19);
const EIGHTH: Slot = at(21);
/// Slot of the constant that stands for one cell.
const CELL: Slot = at(23);
/// What a cell times this is, is one as a word's code.
const PER_CELL: Slot = at(24);
/// What a place times this is, is in cells of the resistance's spline.
const COARSER: Slot = at(25);
/// By how much less than 32 cells the table reaches from its middle.
const MARGIN: Slot = at(26);
/// Signs, by two, with which slopes along u and along v enter the matrix.
const SIGN_U: Slot = at(28);
const SIGN_V: Slot = at(30);
/// Columns of a surface; less the address of its middle cell.
const COLUMNS: Slot = at(32);
const LESS_MIDDLE: Slot = at(36);
/// Less the least step of a word.
const LESS_STEP: Slot = at(35);
/// Constants lie below, variables from here on: a store reaches no constant, whatever its slot.
pub(super) const VARIABLES: u8 = 64;
const fn variable(offset: u8) -> Slot {
    at(VARIABLES + offset)
}
const RATIO: Slot = variable(0);
const PLACE: Slot = variable(2);
const CORNER: Slot = variable(4);
const ERROR: Slot = variable(6);
const WEIGHTS: [Slot; 3] = [variable(8), variable(10), variable(12)];
const SLOPE_WEIGHTS: [Slot; 3] = [variable(14), variable(16), variable(18)];
/// The matrix of cofactors: Y's rows first.
const MATRIX: Slot = variable(20);
/// The determinant and less it: what is added to a negative remainder, and to another.
const DETERMINANT: Slot = variable(24);
const OFFSET: Slot = variable(26);
const SQUARE: Slot = variable(27);
const FIRST: Slot = variable(28);
const SPARE: Slot = variable(29);
const VALUES: Slot = variable(32);
const SLOPES: Slot = variable(36);
/// Words of the scratch memory.
const SLOTS: usize = 2 * VARIABLES as usize;

/// Products of the gain and of the first guess that are summed up.
const GAINS: u8 = 32;
const STARTS: u8 = 4;
/// The determinant is stored times this number; a step is shorter than this number of cells.
pub(super) const STEP: u8 = 4;
/// Turns of −8 that take a place's fraction of a cell to the whole of a word: 64 of them.
const TURN: u8 = 8;

/// Digits of a quotient: as far as a place's bits go, at most sixteen.
pub(super) fn digits(word: Format) -> u8 {
    (Layout::place_bits(word) + 3).min(16)
}

/// What the scratch memory holds at reset: constants.
pub(super) fn constants(layout: &Layout, word: Format) -> Vec<f64> {
    let mut words = vec![0.0; SLOTS];
    let mut set = |slot: Slot, value: f64| words[slot.0 as usize] = value;
    let code = |code: usize| word.real(code as i64);
    let digits = digits(word);
    (0..digits).for_each(|k| set(POWERS.word(k), 2f64.powi(i32::from(k) - i32::from(digits))));
    let singles = [
        (HALF, 0.5),
        (LESS_HALF, -0.5),
        (LESS_ONE, -1.0),
        (QUARTER, 0.25),
        (EIGHTH, 0.125),
        (CELL, 1.0 / Layout::CELLS),
        (PER_CELL, code(Layout::CELLS as usize)),
        (LESS_STEP, -code(1)),
        (COARSER, 2f64.powi(-i32::from(layout.shift()))),
    ];
    singles.into_iter().for_each(|(slot, value)| set(slot, value));
    for (k, axis) in [Axis::X, Axis::Y].into_iter().enumerate() {
        let k = k as u8;
        set(
            MARGIN.word(k),
            1.0 - layout.cells(Surface::RatioX, axis) as f64 / (2.0 * Layout::CELLS),
        );
        set(SIGN_U.word(k), if axis == Axis::X { 0.5 } else { -0.5 });
        set(SIGN_V.word(k), if axis == Axis::X { -0.5 } else { 0.5 });
    }
    for (k, surface) in
        [Surface::RatioX, Surface::RatioY, Surface::Resistance].into_iter().enumerate()
    {
        let columns = layout.coefficients(surface, Axis::X);
        set(COLUMNS.word(k as u8), code(columns * Layout::CELLS as usize));
        set(LESS_MIDDLE.word(k as u8), -code(layout.middle(surface)));
    }
    words
}

/// An instruction as it is executed.
#[derive(Debug, Clone, Copy)]
pub struct Executed<'a> {
    /// Itself.
    pub instruction: &'a Instruction,
    /// The counter before it.
    pub count: u8,
    /// The surface before it.
    pub surface: u8,
    /// Whether it goes on at its target.
    pub jumps: bool,
}

impl Executed<'_> {
    /// Its clocks, where a product takes `product` clocks from its operands' clock.
    pub fn clocks(&self, product: u64) -> u64 {
        let own = if self.instruction.waits() { 2 + product } else { 1 };
        own + u64::from(self.jumps)
    }
}

/// Writes a program.
#[derive(Default)]
struct Writer {
    instructions: Vec<Instruction>,
}

impl Writer {
    fn add(&mut self, operation: Operation, slot: Slot, option: u8) {
        let writes = matches!(operation, Store | Input);
        assert!(!writes || slot.0 >= VARIABLES, "{operation:?} to a constant, {slot:?}");
        self.instructions.push(Instruction { operation, slot, option, target: 0 });
    }

    fn next_address(&self) -> u8 {
        self.instructions.len() as u8
    }

    fn jump(&mut self, operation: Operation, target: u8) {
        self.instructions.push(Instruction { operation, slot: at(0), option: 0, target });
    }

    /// The target of a jump that was written before it was known.
    fn set_target(&mut self, jump: u8) {
        self.instructions[jump as usize].target = self.next_address();
    }

    /// sum += factor · each of the words
    fn products(&mut self, factor: Slot, words: &[Slot]) {
        self.add(Load, factor, 0);
        self.multiply_add(words);
    }

    /// sum += left · each of the words
    fn multiply_add(&mut self, words: &[Slot]) {
        words.iter().for_each(|&word| self.add(Multiply, word, 0));
    }

    fn scalar(&mut self, scalar: Scalar, word: Slot) {
        self.add(MultiplyTable, word, scalar as u8);
    }

    fn store(&mut self, slot: Slot) {
        self.add(Store, slot, 0);
    }

    /// The counter's body is written by `body`, and done `times`.
    fn repeat(&mut self, times: u8, body: impl Fn(&mut Writer)) {
        self.add(Set, at(times - 1), COUNT);
        let start = self.next_address();
        body(self);
        self.jump(Repeat, start);
    }

    /// The body is done for r_x, or x, and then for r_y, or y.
    fn surfaces(&mut self, body: impl Fn(&mut Writer)) {
        let start = self.next_address();
        body(self);
        self.jump(Surfaces, start);
    }
}

impl Program {
    /// The program of a profile whose table has words of this format.
    pub fn new(word: Format) -> Self {
        let digits = digits(word);
        let mut w = Writer::default();
        open_terminal(&mut w);
        w.surfaces(normalise);
        w.surfaces(start);
        let step = w.next_address();
        w.surfaces(weights);
        let surface = w.next_address();
        rows(&mut w);
        let found = column(&mut w);
        residual(&mut w);
        slopes(&mut w);
        w.jump(Surfaces, surface);
        determinant(&mut w);
        w.surfaces(|w| newton(w, digits));
        w.jump(Pass, step);
        w.surfaces(position);
        w.add(Set, at(0), SURFACE);
        w.jump(Found, step);
        w.set_target(found);
        w.add(Output, at(0), 0); //                                                  R = value
        w.jump(End, 0);
        w.jump(End, 0); //                                                           fetched, never done
        Program { instructions: w.instructions, digits }
    }

    /// Clocks from the first instruction to the last, where a product takes `product` clocks from
    /// its operands' clock.
    pub fn clocks(&self, steps: u64, product: u64) -> u64 {
        let mut clocks = 0;
        self.execute(steps, |executed| clocks += executed.clocks(product));
        clocks
    }

    /// Shows each instruction of a program of `steps` steps as it is executed, up to the last. Control does not depend
    /// on data, so that following it is enough.
    pub fn execute(&self, steps: u64, mut show: impl FnMut(Executed)) {
        let (mut at, mut count, mut surface, mut step) = (0, 0, 0, 0);
        loop {
            let instruction = &self.instructions[at];
            let jumps = match instruction.operation {
                Repeat => count != 0,
                Surfaces => surface == 0,
                Pass => step + 1 < steps,
                Found => step == steps,
                _ => false,
            };
            show(Executed { instruction, count, surface, jumps });
            match instruction.operation {
                Set if instruction.option & COUNT != 0 => count = instruction.slot.0,
                Set if instruction.option & SURFACE != 0 => surface = 0,
                Repeat => count = count.saturating_sub(1),
                Surfaces => surface = if jumps { 1 } else { 2 * u8::from(step == steps) },
                Pass => step += 1,
                End => return,
                _ => (),
            }
            at = if jumps { instruction.target.into() } else { at + 1 };
        }
    }

    /// Digits of a quotient.
    pub fn digits(&self) -> u8 {
        self.digits
    }
}

/// Whether the least current is that of an open terminal: [share/2 − limit/2] is negative.
fn open_terminal(w: &mut Writer) {
    w.add(Set, at(0), SCALARS);
    w.add(Input, SPARE, SHARE);
    w.products(HALF, &[SPARE, SPARE]);
    w.scalar(Scalar::Open, LESS_ONE);
    w.add(Store, SPARE, OPEN);
}

/// r ← [32·gain·([r/2 − centre] + what the rounding of r/2 left)].
fn normalise(w: &mut Writer) {
    w.add(Set, at(0), SCALARS);
    w.add(Input, RATIO.of_surface(), 0);
    w.add(Input, SPARE, LOW);
    w.scalar(Scalar::Gain, SPARE);
    w.store(SPARE);
    w.products(HALF, &[RATIO.of_surface(), RATIO.of_surface()]);
    w.scalar(Scalar::Centre, LESS_ONE);
    w.store(RATIO.of_surface()); //                                                  r/2 − centre
    w.repeat(GAINS / 2, |w| {
        w.scalar(Scalar::Gain, RATIO.of_surface());
        w.scalar(Scalar::Gain, RATIO.of_surface());
    });
    w.products(PER_CELL, &[SPARE]);
    w.store(RATIO.of_surface()); //                                                  r
}

/// The first guess: u ← [4·(constant + rise · r)].
fn start(w: &mut Writer) {
    w.add(Set, at(0), SCALARS);
    w.repeat(STARTS, |w| {
        w.scalar(Scalar::StartConstant, LESS_ONE);
        w.scalar(Scalar::StartRatioX, RATIO.word(0));
        w.scalar(Scalar::StartRatioY, RATIO.word(1));
    });
    w.store(PLACE.of_surface());
    clamp(w);
}

/// A place held within the table: saturation holds u + margin at the top, and u − margin at the
/// bottom.
fn clamp(w: &mut Writer) {
    let (place, margin) = (PLACE.of_surface(), MARGIN.of_surface());
    w.products(HALF, &[place, place, margin, margin]);
    w.store(place); //                                                               u + margin
    w.multiply_add(&[place, place]);
    w.products(LESS_ONE, &[margin, margin]);
    w.store(place); //                                                               u − margin
    w.products(HALF, &[place, place, margin, margin]);
    w.store(place); //                                                               u
}

/// The B-spline's weights, and those of its slope per cell, from t: twice the place from the middle
/// of its cell.
///
///   ⅛(1 − t)², ¾ − ¼t², ⅛(1 + t)²  and  ½(t − 1), −t, ½(t + 1)
///
/// The middle one is what the rounded others leave of one, so that their errors count by how much
/// neighbours differ.
fn weights(w: &mut Writer) {
    let place = PLACE.of_surface();
    let ([before, middle, after], [fall, turn, rise]) = (WEIGHTS, SLOPE_WEIGHTS);
    w.products(HALF, &[place, place, CELL]);
    w.store(CORNER.of_surface()); //                                                 u + ½ cell: its floor is the cell
    for from in [place, OFFSET] {
        w.products(from, &[LESS_ONE; TURN as usize]);
        w.add(Store, OFFSET, WRAP); //                                               t = 64·u, wrapped
    }
    w.products(LESS_ONE, &[OFFSET]);
    w.store(turn.of_surface()); //                                                   −t
    w.products(OFFSET, &[OFFSET]);
    w.store(SQUARE); //                                                              t²
    for (weight, offset) in [(before, turn.of_surface()), (after, OFFSET)] {
        w.products(QUARTER, &[HALF, offset]);
        w.products(EIGHTH, &[SQUARE]);
        w.store(weight.of_surface());
    }
    w.products(LESS_ONE, &[LESS_ONE, before.of_surface(), after.of_surface()]);
    w.store(middle.of_surface()); //                                                 exact
    w.products(HALF, &[OFFSET, LESS_ONE]);
    w.store(fall.of_surface());
    w.multiply_add(&[OFFSET]);
    w.products(LESS_HALF, &[LESS_ONE]);
    w.store(rise.of_surface());
}

/// Three rows of a surface: the value and the slope along u of each.
fn rows(w: &mut Writer) {
    w.add(LoadCell, CORNER.word(0), 0);
    w.multiply_add(&[PER_CELL]);
    w.add(LoadCell, CORNER.word(1), 0);
    w.multiply_add(&[COLUMNS.of_surface()]);
    w.products(LESS_ONE, &[LESS_MIDDLE.of_surface()]);
    w.store(FIRST); //                                                               the first coefficient's address
    w.repeat(3, |w| {
        w.products(HALF, &[FIRST, FIRST]);
        w.add(Base, at(0), 0);
        w.products(CELL, &[COLUMNS.of_surface()]);
        w.store(FIRST);
        for (weights, row) in [(WEIGHTS, VALUES), (SLOPE_WEIGHTS, SLOPES)] {
            (0..3).for_each(|k| w.add(MultiplyTable, weights[k].word(0), k as u8));
            w.store(row.of_counter());
        }
    });
}

/// sum += weights along v · words of the rows, the first of which the counter called 2.
fn along_v(w: &mut Writer, weights: [Slot; 3], rows: Slot) {
    (0..3).for_each(|k| w.products(weights[k].word(1), &[rows.word(2 - k as u8)]));
}

/// The surface's value is the sum; where all steps are done, this was the resistance: the jump's
/// place.
fn column(w: &mut Writer) -> u8 {
    along_v(w, WEIGHTS, VALUES);
    let found = w.next_address();
    w.jump(Found, 0);
    found
}

/// What is left of the ratio: e ← −[value − r]
fn residual(w: &mut Writer) {
    w.products(LESS_ONE, &[RATIO.of_surface()]);
    w.add(Store, ERROR.of_surface(), CHECK);
    w.multiply_add(&[ERROR.of_surface()]);
    w.store(ERROR.of_surface());
}

/// The surface's row of the matrix of cofactors: those of X are −X_v, X_u, those of Y are Y_v,
/// −Y_u.
fn slopes(w: &mut Writer) {
    for (weights, rows, sign, place) in
        [(WEIGHTS, SLOPES, SIGN_U, 1), (SLOPE_WEIGHTS, VALUES, SIGN_V, 0)]
    {
        along_v(w, weights, rows);
        w.store(SPARE);
        w.products(sign.of_surface(), &[SPARE, SPARE]);
        w.store(MATRIX.of_pair(place));
    }
}

/// det ← [4·(X_u·Y_v − X_v·Y_u)], and less it.
fn determinant(w: &mut Writer) {
    let [less_x_v, x_u, y_v, less_y_u] = [0, 1, 2, 3].map(|k| MATRIX.word(k));
    w.products(LESS_ONE, &[less_y_u]);
    w.store(SPARE);
    w.repeat(STEP, |w| {
        w.products(x_u, &[y_v]);
        w.products(less_x_v, &[SPARE]);
    });
    w.store(DETERMINANT.word(1));
    w.products(LESS_ONE, &[DETERMINANT.word(1)]);
    w.store(DETERMINANT.word(0));
}

/// A step along one axis: u ← [u + (Y_v·e_x − X_v·e_y)/det], v ← [v + (X_u·e_y − Y_u·e_x)/det].
///
/// The quotient is made digit by digit, each +1 or −1, so that the remainder comes nearer to zero.
fn newton(w: &mut Writer, digits: u8) {
    w.products(MATRIX.word(2).of_surface(), &[ERROR.word(0)]);
    w.products(MATRIX.of_surface(), &[ERROR.word(1)]);
    w.products(DETERMINANT.word(1), &[POWERS.word(0)]); //                           half of the last digit
    w.products(HALF, &[LESS_STEP]); //                                               the sum is not to be rounded
    w.repeat(digits, |w| {
        w.add(LoadDigit, DETERMINANT, 0);
        w.multiply_add(&[POWERS.of_counter()]);
    });
    w.add(LoadQuotient, at(0), 0);
    w.store(SPARE); //                                                               the remainder goes
    let place = PLACE.of_surface();
    w.multiply_add(&[HALF, HALF]);
    w.products(HALF, &[place, place]);
    w.store(place);
    clamp(w);
}

/// x ← [origin + pitch · u], y likewise; then u in cells of the resistance's spline.
fn position(w: &mut Writer) {
    let place = PLACE.of_surface();
    w.add(Set, at(0), SCALARS);
    (0..2).for_each(|_| w.scalar(Scalar::Pitch, place));
    w.scalar(Scalar::Origin, LESS_ONE);
    w.add(Output, at(0), 0);
    w.products(COARSER, &[place]);
    w.store(place);
}
