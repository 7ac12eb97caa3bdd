// SPDX-License-Identifier: MIT OR Apache-2.0
//! The places of mutants in the syntax tree, genre by genre.

use super::{Found, Index, Weaver, call};
use crate::edits::Edit;
use crate::mutant::Genre;
use crate::tokens::one_line;
use quote::ToTokens;
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, ExprBinary, Signature, UnOp};

const CONSTANT: &str = "in a constant";

impl<'ast> Visit<'ast> for Weaver<'_> {
    fn visit_item_fn(&mut self, node: &'ast syn::ItemFn) {
        self.function(&node.sig, &node.block, |weaver| visit::visit_item_fn(weaver, node));
    }

    fn visit_impl_item_fn(&mut self, node: &'ast syn::ImplItemFn) {
        self.function(&node.sig, &node.block, |weaver| visit::visit_impl_item_fn(weaver, node));
    }

    fn visit_trait_item_fn(&mut self, node: &'ast syn::TraitItemFn) {
        match &node.default {
            Some(block) => {
                self.function(&node.sig, block, |weaver| visit::visit_trait_item_fn(weaver, node));
            }
            None => visit::visit_trait_item_fn(self, node),
        }
    }

    fn visit_expr_binary(&mut self, node: &'ast ExprBinary) {
        self.binary(node);
    }

    fn visit_expr_unary(&mut self, node: &'ast syn::ExprUnary) {
        if let UnOp::Not(_) | UnOp::Neg(_) = node.op
            && let Some(found) = self.take(Genre::UnaryOperator, start(&node.op))
        {
            let operand = one_line(node.expr.to_token_stream(), None);
            let mutants: Found =
                found.into_iter().map(|(index, _)| (index, operand.clone())).collect();
            self.choose(bytes(node), &mutants);
        }
        visit::visit_expr_unary(self, node);
    }

    fn visit_expr_match(&mut self, node: &'ast syn::ExprMatch) {
        let before = self.numbers.0.len() + 1;
        for arm in &node.arms {
            if let Some(found) = self.take(Genre::MatchArm, start(arm)) {
                let indices: Vec<Index> = found.iter().map(|(index, _)| *index).collect();
                let (first, last) = self.numbers.give(&indices);
                let guard = format!(" if {} == 0", call(first, last));
                self.edits.push(Edit::insertion(bytes(&arm.pat).end, guard));
            }
        }
        let deleted = self.numbers.0.len();
        if deleted >= before {
            // The compiler names the operand where arms are missing.
            let operand = bytes(&node.expr);
            self.edits.push(Edit::insertion(operand.start, format!("/*?{before},{deleted}*/ ")));
            self.edits.push(Edit::insertion(operand.end, format!(" /*.{before}*/")));
        }
        for (_, guard) in node.arms.iter().filter_map(|arm| arm.guard.as_ref()) {
            if let Some(found) = self.take(Genre::MatchArmGuard, start(guard)) {
                self.choose(bytes(guard), &found);
            }
        }
        visit::visit_expr_match(self, node);
    }

    fn visit_expr_struct(&mut self, node: &'ast syn::ExprStruct) {
        if let Some(base) = &node.rest {
            for field in &node.fields {
                if let Some(found) = self.take(Genre::StructField, start(field)) {
                    self.field(&node.path, field, base, found);
                }
            }
        }
        visit::visit_expr_struct(self, node);
    }

    fn visit_item_const(&mut self, node: &'ast syn::ItemConst) {
        self.behind(Some(CONSTANT), |weaver| visit::visit_item_const(weaver, node));
    }

    fn visit_item_static(&mut self, node: &'ast syn::ItemStatic) {
        self.behind(Some(CONSTANT), |weaver| visit::visit_item_static(weaver, node));
    }

    fn visit_impl_item_const(&mut self, node: &'ast syn::ImplItemConst) {
        self.behind(Some(CONSTANT), |weaver| visit::visit_impl_item_const(weaver, node));
    }

    fn visit_trait_item_const(&mut self, node: &'ast syn::TraitItemConst) {
        self.behind(Some(CONSTANT), |weaver| visit::visit_trait_item_const(weaver, node));
    }

    fn visit_expr_const(&mut self, node: &'ast syn::ExprConst) {
        self.behind(Some(CONSTANT), |weaver| visit::visit_expr_const(weaver, node));
    }

    fn visit_expr_repeat(&mut self, node: &'ast syn::ExprRepeat) {
        self.visit_expr(&node.expr);
        self.behind(Some(CONSTANT), |weaver| weaver.visit_expr(&node.len));
    }

    fn visit_type(&mut self, node: &'ast syn::Type) {
        self.behind(Some(CONSTANT), |weaver| visit::visit_type(weaver, node));
    }

    fn visit_pat(&mut self, node: &'ast syn::Pat) {
        self.behind(Some(CONSTANT), |weaver| visit::visit_pat(weaver, node));
    }

    fn visit_variant(&mut self, node: &'ast syn::Variant) {
        self.behind(Some(CONSTANT), |weaver| visit::visit_variant(weaver, node));
    }
}

impl Weaver<'_> {
    /// Puts a `match` in the place of an expression.
    fn choose(&mut self, range: Range<usize>, mutants: &[(Index, String)]) {
        let (before, behind) = self.arms(mutants);
        self.edits.push(Edit::around(range, format!("({before}"), format!("{behind})")));
    }

    /// A function's value, and what is in it.
    fn function(&mut self, sig: &Signature, block: &syn::Block, go_on: impl FnOnce(&mut Self)) {
        let constant = self.constant.contains(&sig.ident.to_string());
        let keyword = sig.constness.as_ref().map(bytes);
        if let Some(range) = keyword.clone().filter(|_| !constant) {
            self.edits.push(Edit { range, pieces: Vec::new() });
        }
        let barrier =
            (constant && keyword.is_some()).then_some("in a function that constants call");
        self.behind(barrier, |weaver| {
            if let Some(body) = block.stmts.first().map(start)
                && let Some(found) = weaver.take_value(sig, body)
            {
                let returns =
                    found.into_iter().map(|(index, value)| (index, format!("return {value}")));
                let (before, behind) = weaver.arms(&returns.collect::<Vec<_>>());
                weaver.edits.push(Edit::insertion(body, format!("{before}{{}}{behind} ")));
            }
            go_on(weaver);
        });
    }

    /// Mutants of a function's value, which must be of its one type.
    fn take_value(&mut self, sig: &Signature, body: usize) -> Option<Found> {
        let hidden =
            sig.output.to_token_stream().into_iter().any(|token| token.to_string() == "impl");
        let mut found = None;
        self.behind(hidden.then_some("of a type `impl Trait`"), |weaver| {
            found = weaver.take(Genre::FnValue, body);
        });
        found
    }

    /// A field that is deleted is that of the base.
    fn field(&mut self, path: &syn::Path, field: &syn::FieldValue, base: &Expr, found: Found) {
        let one_line = |tokens: proc_macro2::TokenStream| one_line(tokens, None);
        let [name, of] =
            [field.member.to_token_stream().to_string(), one_line(base.to_token_stream())];
        let from_base = match is_place(base) {
            true => format!("({of}).{name}"),
            false => format!("({} {{ ..{of} }}).{name}", one_line(path.to_token_stream())),
        };
        let mutants: Found =
            found.into_iter().map(|(index, _)| (index, from_base.clone())).collect();
        let (before, behind) = self.arms(&mutants);
        let before = if field.colon_token.is_some() { before } else { format!("{name}: {before}") };
        self.edits.push(Edit::around(bytes(&field.expr), before, behind));
    }

    /// Operators that no parentheses separate. A mutant is the whole text with one of them replaced,
    /// so that it binds as the new operator does.
    fn binary(&mut self, node: &ExprBinary) {
        let (mut operators, mut operands) = (Vec::new(), Vec::new());
        chain(node, &mut operators, &mut operands);
        let lets = has_let(&node.left) || has_let(&node.right);
        let mut mutants = Found::new();
        for operator in operators {
            let range = bytes(&operator);
            let barrier = (lets && matches!(operator, BinOp::And(_)))
                .then_some("between conditions with `let`");
            self.behind(barrier, |weaver| {
                for (index, new) in
                    weaver.take(Genre::BinaryOperator, range.start).into_iter().flatten()
                {
                    let text = one_line(node.to_token_stream(), Some((range.clone(), &new)));
                    mutants.push((index, text));
                }
            });
        }
        if !mutants.is_empty() {
            self.choose(bytes(node), &mutants);
        }
        for operand in operands {
            self.visit_expr(operand);
        }
    }
}

/// The operators of an expression, and what they are applied to. Operators of assignments end it, and
/// so does `&&` before a condition with `let`.
fn chain<'a>(node: &'a ExprBinary, operators: &mut Vec<BinOp>, operands: &mut Vec<&'a Expr>) {
    operators.push(node.op);
    let splits = assigns(&node.op) || has_let(&node.left) || has_let(&node.right);
    for side in [&*node.left, &*node.right] {
        match side {
            Expr::Binary(inner) if !splits && !assigns(&inner.op) => {
                chain(inner, operators, operands)
            }
            other => operands.push(other),
        }
    }
}

fn has_let(node: &Expr) -> bool {
    match node {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

fn assigns(operator: &BinOp) -> bool {
    let text = operator.to_token_stream().to_string();
    text.ends_with('=')
        && !matches!(operator, BinOp::Eq(_) | BinOp::Ne(_) | BinOp::Le(_) | BinOp::Ge(_))
}

/// Whether an expression names something, so that a field of it can be taken alone.
fn is_place(node: &Expr) -> bool {
    match node {
        Expr::Path(_) => true,
        Expr::Field(field) => is_place(&field.base),
        Expr::Paren(paren) => is_place(&paren.expr),
        Expr::Unary(unary) => matches!(unary.op, UnOp::Deref(_)) && is_place(&unary.expr),
        _ => false,
    }
}

fn bytes(node: &impl Spanned) -> Range<usize> {
    node.span().byte_range()
}

fn start(node: &impl Spanned) -> usize {
    bytes(node).start
}
