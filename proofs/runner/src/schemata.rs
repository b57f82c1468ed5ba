//! Many mutants in one copy of the kernel: each change stands beside what it replaces, and a selector decides at run time.
//!
//! A mutant is given as text that replaces text. Both texts of the file are parsed, and the smallest part of the program that contains the
//! change, and whose value can be chosen, becomes `if crate::selected(17) { new } else { old }`. A part of that kind is an expression where a
//! value is wanted (not a place: nothing is assigned to the copy of a value), a statement, or the inside of a block. A mutant whose change
//! lies in no such part (a constant, a type, a signature) is compiled alone.

use std::collections::BTreeSet;
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

/// A change of one file.
#[derive(Clone, Copy, Debug)]
pub struct Change<'a> {
    /// What the selector knows it by.
    pub number: usize,
    /// The text to replace; it stands in the file exactly once.
    pub find: &'a str,
    /// What replaces it.
    pub replace: &'a str,
}

/// How a part of the program is written when its value is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Form {
    /// `(if … { new } else { old })`
    Value,
    /// `if … { new } else { old }`: a statement, or the inside of a block.
    Body,
}

type Part = (usize, usize, Form);

/// A part of the file with what may stand in its place.
struct Choice {
    part: Range<usize>,
    form: Form,
    number: usize,
    new: String,
}

/// The text of the file with all changes in it.
///
/// # Errors
/// The numbers of the changes that lie in no part whose value can be chosen, or what is wrong with the text.
pub fn instrument(text: &str, changes: &[Change]) -> Result<String, String> {
    let parts = parts(text)?;
    let choices = changes.iter().map(|change| choice(text, &parts, change)).collect::<Result<Vec<_>, _>>()?;
    Ok(written(text, 0..text.len(), &choices.iter().collect::<Vec<_>>()))
}

/// Whether the change lies in a part of the file whose value can be chosen.
pub fn is_selectable(text: &str, change: &Change) -> bool {
    parts(text).and_then(|parts| choice(text, &parts, change)).is_ok()
}

/// A crate's root with a cell for each of `most` mutants, which says whether it is selected, and with `rest`, which fills them.
///
/// # Errors
/// The root is not as it is expected to be.
pub fn with_cells(text: &str, most: usize, rest: &str) -> Result<String, String> {
    const FORBIDS: &str = "#![forbid(unsafe_code)]";
    if text.matches(FORBIDS).count() != 1 {
        return Err(format!("lib.rs does not have `{FORBIDS}` once"));
    }
    let text = text.replacen(FORBIDS, "", 1);
    Ok(format!(
        "{text}\nstatic mut SELECTED: [u32; {most}] = [0; {most}];
         #[inline(always)]
         pub const fn selected(number: usize) -> bool {{ unsafe {{ SELECTED[number] != 0 }} }}
         {rest}"
    ))
}

/// The smallest part of the text that holds the change, and that is a part of the changed text too: it has not come apart.
fn choice(text: &str, parts: &BTreeSet<Part>, change: &Change) -> Result<Choice, String> {
    let Change { number, find, replace } = *change;
    let start = text.find(find).ok_or_else(|| format!("`{find}` is not there"))?;
    let changed = text.replacen(find, replace, 1);
    let after = self::parts(&changed)?;
    // What the two texts have in common belongs to neither.
    let same = |(a, b): &(u8, u8)| a == b;
    let head = find.bytes().zip(replace.bytes()).take_while(same).count();
    let rest = (&find.as_bytes()[head..], &replace.as_bytes()[head..]);
    let tail = rest.0.iter().rev().zip(rest.1.iter().rev()).take_while(|(a, b)| a == b).count();
    let from = start + head;
    let to = start + find.len() - tail;
    // The change is before the end of what holds it.
    let grown = |end: usize| end + replace.len() - find.len();
    let fits =
        |(first, last, form): &&Part| *first <= from && to <= *last && after.contains(&(*first, grown(*last), *form));
    let (first, last, form) = parts
        .iter()
        .filter(fits)
        .min_by_key(|(first, last, _)| last - first)
        .ok_or_else(|| format!("`{find}` lies in no part whose value can be chosen"))?;
    Ok(Choice { part: *first..*last, form: *form, number, new: changed[*first..grown(*last)].to_owned() })
}

/// The text of `range`, with the choices inside it.
fn written(text: &str, range: Range<usize>, choices: &[&Choice]) -> String {
    let mut out = String::new();
    let mut at = range.start;
    while let Some(outermost) = choices
        .iter()
        .filter(|choice| choice.part.start >= at && choice.part.end <= range.end)
        .min_by_key(|choice| (choice.part.start, std::cmp::Reverse((choice.part.end, choice.form))))
    {
        let Choice { part, form, .. } = outermost;
        let (here, others): (Vec<&Choice>, Vec<&Choice>) =
            choices.iter().partition(|choice| choice.part == *part && choice.form == *form);
        out.push_str(&text[at..part.start]);
        out.push_str(if *form == Form::Value { "(" } else { "" });
        for choice in here {
            out.extend(["if crate::selected(", &choice.number.to_string(), ") { ", &choice.new, " } else "]);
        }
        // What is left may lie in it; also the same part in the other form: a statement, and the value that it is.
        let old = written(text, part.clone(), &others);
        out.extend(["{ ", &old, " }"]);
        out.push_str(if *form == Form::Value { ")" } else { "" });
        at = part.end;
    }
    out.push_str(&text[at..range.end]);
    out
}

/// The parts of the text whose value can be chosen, each from its first byte to behind its last.
fn parts(text: &str) -> Result<BTreeSet<Part>, String> {
    let file = syn::parse_file(text).map_err(|error| error.to_string())?;
    let mut finder = Finder { parts: BTreeSet::new(), value: false };
    finder.visit_file(&file);
    Ok(finder.parts)
}

struct Finder {
    parts: BTreeSet<Part>,
    /// Whether the expression that is visited next stands where a value is wanted.
    value: bool,
}

impl Finder {
    fn add(&mut self, node: &impl Spanned, form: Form) {
        let range = node.span().byte_range();
        self.parts.insert((range.start, range.end, form));
    }

    /// An expression where a value is wanted.
    fn value(&mut self, expression: &syn::Expr) {
        self.value = true;
        self.visit_expr(expression);
    }

    /// What a branch comes to. Only behind a comma can it be written as a value in parentheses.
    fn arm(&mut self, arm: &syn::Arm) {
        if arm.comma.is_some() { self.value(&arm.body) } else { self.place(&arm.body) }
    }

    /// An argument. A closure is of a type of its own: the choice is in its body.
    fn argument(&mut self, expression: &syn::Expr) {
        if matches!(expression, syn::Expr::Closure(_)) { self.place(expression) } else { self.value(expression) }
    }

    /// An expression where something else is wanted: a place, or a constant.
    fn place(&mut self, expression: &syn::Expr) {
        self.value = false;
        self.visit_expr(expression);
    }
}

/// Whether the condition binds names.
fn binds(condition: &syn::Expr) -> bool {
    match condition {
        syn::Expr::Let(_) => true,
        syn::Expr::Binary(both) => binds(&both.left) || binds(&both.right),
        _ => false,
    }
}

impl<'ast> Visit<'ast> for Finder {
    /// Nothing in a constant can be chosen at run time.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}

    fn visit_block(&mut self, block: &'ast syn::Block) {
        if let (Some(first), Some(last)) = (block.stmts.first(), block.stmts.last()) {
            let (start, end) = (first.span().byte_range().start, last.span().byte_range().end);
            self.parts.insert((start, end, Form::Body));
        }
        visit::visit_block(self, block);
    }

    fn visit_stmt(&mut self, statement: &'ast syn::Stmt) {
        match statement {
            syn::Stmt::Local(local) => {
                let Some(init) = &local.init else { return };
                self.value(&init.expr);
                if let Some((_, diverge)) = &init.diverge {
                    self.place(diverge);
                }
            }
            syn::Stmt::Expr(expression, _) => {
                self.add(statement, Form::Body);
                self.place(expression);
            }
            syn::Stmt::Macro(_) => self.add(statement, Form::Body),
            syn::Stmt::Item(_) => visit::visit_stmt(self, statement),
        }
    }

    fn visit_expr(&mut self, expression: &'ast syn::Expr) {
        use syn::Expr;
        if std::mem::take(&mut self.value) && !binds(expression) {
            self.add(expression, Form::Value);
        }
        match expression {
            Expr::Array(array) => array.elems.iter().for_each(|one| self.value(one)),
            Expr::Assign(assign) => {
                self.place(&assign.left);
                self.value(&assign.right);
            }
            Expr::Binary(both) => {
                let assigns = both.op.span().source_text().is_some_and(|op| op.ends_with('=') && op.len() > 1)
                    && !matches!(
                        both.op,
                        syn::BinOp::Eq(_) | syn::BinOp::Le(_) | syn::BinOp::Ge(_) | syn::BinOp::Ne(_)
                    );
                if assigns {
                    self.place(&both.left);
                } else {
                    self.value(&both.left);
                }
                self.value(&both.right);
            }
            Expr::Call(call) => {
                self.place(&call.func);
                call.args.iter().for_each(|one| self.argument(one));
            }
            // Its type may change with it.
            Expr::Cast(cast) => self.place(&cast.expr),
            Expr::Closure(closure) => self.value(&closure.body),
            Expr::If(branch) => {
                self.value(&branch.cond);
                self.visit_block(&branch.then_branch);
                if let Some((_, other)) = &branch.else_branch {
                    self.place(other);
                }
            }
            Expr::Index(index) => {
                self.place(&index.expr);
                self.value(&index.index);
            }
            Expr::Match(choice) => {
                self.place(&choice.expr);
                for arm in &choice.arms {
                    if let Some((_, guard)) = &arm.guard {
                        self.value(guard);
                    }
                    self.arm(arm);
                }
            }
            Expr::MethodCall(call) => {
                self.place(&call.receiver);
                call.args.iter().for_each(|one| self.argument(one));
            }
            Expr::Paren(inner) => self.value(&inner.expr),
            Expr::Range(range) => {
                range.start.iter().chain(&range.end).for_each(|one| self.value(one));
            }
            Expr::Repeat(repeat) => self.value(&repeat.expr),
            Expr::Return(back) => back.expr.iter().for_each(|one| self.value(one)),
            Expr::Struct(whole) => {
                for field in &whole.fields {
                    if field.colon_token.is_some() {
                        self.value(&field.expr);
                    }
                }
                if let Some(rest) = &whole.rest {
                    self.place(rest);
                }
            }
            Expr::Tuple(tuple) => tuple.elems.iter().for_each(|one| self.value(one)),
            Expr::Unary(unary) if !matches!(unary.op, syn::UnOp::Deref(_)) => self.value(&unary.expr),
            Expr::While(repeat) => {
                self.value(&repeat.cond);
                self.visit_block(&repeat.body);
            }
            // What is looped over is a value, but of a type of its own; the condition of a block is its own business.
            _ => visit::visit_expr(self, expression),
        }
    }
}
