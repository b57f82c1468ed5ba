//! Finds what Kani or Creusot cannot take.
//!
//! Kani 0.67 does not compile a constant index into an array whose length is a parameter (some instance may have length 0), and fails a
//! harness that reaches a sub-array pattern. `use creusot_std::prelude::*` shadows `Clone`, `PartialEq` and `Default`.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use syn::visit::{self, Visit};
use syn::{Expr, ExprIndex, GenericArgument, Generics, Item, Local, Pat, PathArguments, Type, UseTree};

/// What is known of an array's length.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Length {
    Fixed,
    Generic,
}

type Known = BTreeMap<String, Length>;

#[derive(Default)]
struct Finder {
    /// The fields of all files that are arrays. A name that has both lengths counts as generic.
    fields: Known,
    /// The constant parameters that are in scope.
    parameters: BTreeSet<String>,
    /// Arrays and values of fixed types among arguments and variables.
    variables: Known,
    /// Variables that never have another value than a number.
    numbers: BTreeSet<String>,
    found: Vec<String>,
}

fn report(found: &mut Vec<String>, span: proc_macro2::Span, what: &str) {
    found.push(format!("line {}: {what}", span.start().line));
}

impl Finder {
    /// Whether a type is an array, and whether its length, or that of anything in it, is a parameter.
    fn length(&self, kind: &Type) -> Option<Length> {
        match kind {
            Type::Array(array) if self.is_parameter(&array.len) => Some(Length::Generic),
            Type::Array(_) => Some(Length::Fixed),
            Type::Reference(reference) => self.length(&reference.elem),
            Type::Path(path) => {
                let last = path.path.segments.last()?;
                let PathArguments::AngleBracketed(given) = &last.arguments else { return None };
                let generic = given.args.iter().any(|argument| match argument {
                    GenericArgument::Const(value) => self.is_parameter(value),
                    GenericArgument::Type(Type::Path(path)) => {
                        path.path.get_ident().is_some_and(|name| self.parameters.contains(&name.to_string()))
                    }
                    _ => false,
                });
                Some(if generic { Length::Generic } else { Length::Fixed })
            }
            _ => None,
        }
    }

    /// Whether a parameter occurs in the expression.
    fn is_parameter(&self, value: &Expr) -> bool {
        struct Names<'a>(&'a BTreeSet<String>, bool);
        impl Visit<'_> for Names<'_> {
            fn visit_ident(&mut self, name: &proc_macro2::Ident) {
                self.1 |= self.0.contains(&name.to_string());
            }
        }
        let mut names = Names(&self.parameters, false);
        names.visit_expr(value);
        names.1
    }

    fn is_constant(&self, index: &Expr) -> bool {
        match index {
            Expr::Lit(_) => true,
            Expr::Paren(inner) => self.is_constant(&inner.expr),
            Expr::Binary(both) => self.is_constant(&both.left) && self.is_constant(&both.right),
            Expr::Path(path) => path.path.segments.last().is_some_and(|last| {
                let name = last.ident.to_string();
                let constant = name.len() > 1 && !name.chars().any(char::is_lowercase);
                (constant && !self.parameters.contains(&name)) || self.numbers.contains(&name)
            }),
            _ => false,
        }
    }

    /// Whether what is indexed is known to have a length that no parameter decides.
    fn is_fixed(&self, base: &Expr) -> bool {
        match base {
            Expr::Path(path) => {
                path.path.get_ident().is_some_and(|name| self.variables.get(&name.to_string()) == Some(&Length::Fixed))
            }
            Expr::Field(field) => {
                let syn::Member::Named(name) = &field.member else { return false };
                self.is_fixed(&field.base) || self.fields.get(&name.to_string()) == Some(&Length::Fixed)
            }
            Expr::MethodCall(call) => call.method.to_string().ends_with("e_bytes"),
            Expr::Array(_) => true,
            Expr::Repeat(repeat) => !self.is_parameter(&repeat.len),
            Expr::Paren(inner) => self.is_fixed(&inner.expr),
            Expr::Reference(inner) => self.is_fixed(&inner.expr),
            _ => false,
        }
    }

    fn with(&mut self, generics: Option<&Generics>, visit: impl FnOnce(&mut Self)) {
        let (parameters, variables, numbers) = (self.parameters.clone(), self.variables.clone(), self.numbers.clone());
        let names = generics.into_iter().flat_map(Generics::const_params);
        self.parameters.extend(names.map(|parameter| parameter.ident.to_string()));
        visit(self);
        (self.parameters, self.variables, self.numbers) = (parameters, variables, numbers);
    }
}

impl<'a> Visit<'a> for Finder {
    fn visit_item(&mut self, item: &'a Item) {
        let generics = match item {
            Item::Fn(function) => Some(&function.sig.generics),
            Item::Impl(block) => Some(&block.generics),
            Item::Trait(item) => Some(&item.generics),
            _ => None,
        };
        self.with(generics, |finder| visit::visit_item(finder, item));
    }

    fn visit_impl_item_fn(&mut self, function: &'a syn::ImplItemFn) {
        self.with(Some(&function.sig.generics), |finder| visit::visit_impl_item_fn(finder, function));
    }

    fn visit_pat_type(&mut self, argument: &'a syn::PatType) {
        if let (Pat::Ident(name), Some(length)) = (&*argument.pat, self.length(&argument.ty)) {
            self.variables.insert(name.ident.to_string(), length);
        }
        visit::visit_pat_type(self, argument);
    }

    fn visit_local(&mut self, local: &'a Local) {
        if let (Pat::Ident(name), Some(init)) = (&local.pat, &local.init) {
            let text = name.ident.to_string();
            self.variables.remove(&text);
            self.numbers.remove(&text);
            if self.is_fixed(&init.expr) {
                self.variables.insert(text.clone(), Length::Fixed);
            }
            if name.mutability.is_none() && matches!(&*init.expr, Expr::Lit(_)) {
                self.numbers.insert(text);
            }
        }
        visit::visit_local(self, local);
    }

    fn visit_expr_index(&mut self, index: &'a ExprIndex) {
        if !self.parameters.is_empty() && self.is_constant(&index.index) && !self.is_fixed(&index.expr) {
            let span = index.bracket_token.span.open();
            report(
                &mut self.found,
                span,
                "a constant index into an array whose length may be a parameter: use first() or a loop",
            );
        }
        visit::visit_expr_index(self, index);
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        if let UseTree::Path(root) = &item.tree {
            let mut tree = &*root.tree;
            while let UseTree::Path(path) = tree {
                tree = &path.tree;
            }
            if root.ident == "creusot_std" && matches!(tree, UseTree::Glob(_)) {
                report(&mut self.found, root.ident.span(), "everything of creusot_std is imported: name what is used");
            }
        }
    }

    /// The body of a harness, and of any other macro that is called with a block.
    fn visit_macro(&mut self, call: &'a syn::Macro) {
        for token in call.tokens.clone() {
            let TokenTree::Group(group) = token else { continue };
            if group.delimiter() != Delimiter::Brace {
                continue;
            }
            if let Ok(block) = syn::parse2::<syn::Block>(TokenStream::from(TokenTree::Group(group))) {
                self.with(None, |finder| finder.visit_block(&block));
            }
        }
    }
}

/// Sub-array patterns: in brackets an element that is `..`, or a name for it. Found among the tokens, so in macros too.
fn patterns(tokens: TokenStream, found: &mut Vec<String>) {
    for token in tokens {
        let TokenTree::Group(group) = token else { continue };
        let elements: Vec<String> = {
            let text: Vec<TokenTree> = group.stream().into_iter().collect();
            let is_comma = |token: &TokenTree| matches!(token, TokenTree::Punct(sign) if sign.as_char() == ',');
            text.split(is_comma).map(|one| one.iter().map(ToString::to_string).collect()).collect()
        };
        let rest = |element: &String| element.ends_with("@..") || (element == ".." && elements.len() > 1);
        if group.delimiter() == Delimiter::Bracket && elements.iter().any(rest) {
            report(found, group.span_open(), "a sub-array pattern: use an index or a cast");
        }
        patterns(group.stream(), found);
    }
}

/// What is known to be weak in Kani: a contract that is used without being checked, and quantifiers that are ignored. Among the
/// tokens too.
fn weak(tokens: TokenStream, found: &mut Vec<String>) {
    let mut before = String::new();
    for token in tokens {
        match token {
            TokenTree::Group(group) => {
                weak(group.stream(), found);
                before.clear();
            }
            TokenTree::Ident(name) if name == "stub_verified" => {
                report(
                    found,
                    name.span(),
                    "stub_verified: Kani does not check that the contract was proved (4294, 4295)",
                );
            }
            TokenTree::Ident(name) if before == "kani::" && (name == "forall" || name == "exists") => {
                report(found, name.span(), "a quantifier of Kani: it may be ignored (4282)");
            }
            TokenTree::Ident(name) => before = name.to_string(),
            other => before.push_str(&other.to_string()),
        }
    }
}

/// Adds the fields of a file that are arrays.
fn fields(file: &syn::File, known: &mut Known) {
    for item in &file.items {
        let Item::Struct(item) = item else { continue };
        let parameters = item.generics.const_params().map(|parameter| parameter.ident.to_string()).collect();
        let finder = Finder { parameters, ..Finder::default() };
        for field in &item.fields {
            let (Some(name), Type::Array(_)) = (&field.ident, &field.ty) else { continue };
            let generic = known.get(&name.to_string()) == Some(&Length::Generic);
            let length = if generic { Some(Length::Generic) } else { finder.length(&field.ty) };
            known.extend(length.map(|length| (name.to_string(), length)));
        }
    }
}

/// What is found in these texts, file by file.
pub fn found(texts: &[String]) -> Vec<Vec<String>> {
    let files: Vec<_> = texts.iter().map(|text| syn::parse_file(text).expect("a Rust file")).collect();
    let mut known = Known::new();
    for file in &files {
        fields(file, &mut known);
    }
    let look = |(file, text): (&syn::File, &String)| {
        let mut finder = Finder { fields: known.clone(), ..Finder::default() };
        finder.visit_file(file);
        let tokens: TokenStream = text.parse().expect("tokens");
        patterns(tokens.clone(), &mut finder.found);
        weak(tokens, &mut finder.found);
        finder.found
    };
    files.iter().zip(texts).map(look).collect()
}
