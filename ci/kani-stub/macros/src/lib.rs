//! The attributes of the stand-in for Kani's library.
//!
//! `requires` and `ensures` keep the function as it is and put their condition into a closure that nobody calls, at the
//! start of its body: so the compiler sees the condition with the arguments and the type of the result in scope. The
//! others return the item unchanged. Like Kani's, the closures come with an `unsafe` block of the macro's own, so that
//! a crate that forbids unsafe code is checked under the same circumstances.

use proc_macro::{Delimiter, Group, TokenStream, TokenTree};

/// Marks a proof.
#[proc_macro_attribute]
pub fn proof(_: TokenStream, item: TokenStream) -> TokenStream {
    with_attribute("#[allow(dead_code)]", item)
}

/// Marks the proof of a function's contract. The function it names must exist.
#[proc_macro_attribute]
pub fn proof_for_contract(function: TokenStream, item: TokenStream) -> TokenStream {
    let item = at_start_of_body(item, |_| parse(&format!("let _ = {function}; kani::internal::init_contracts();")));
    with_attribute("#[allow(dead_code)]", item)
}

/// How often loops are unrolled.
#[proc_macro_attribute]
pub fn unwind(_: TokenStream, item: TokenStream) -> TokenStream {
    item
}

/// Which solver is used.
#[proc_macro_attribute]
pub fn solver(_: TokenStream, item: TokenStream) -> TokenStream {
    item
}

/// A precondition: an expression of type `bool` over the arguments.
#[proc_macro_attribute]
pub fn requires(condition: TokenStream, item: TokenStream) -> TokenStream {
    at_start_of_body(item, |_| {
        parse(&format!(
            "#[allow(unused_variables, unused_parens)] let requires = || -> bool {{ unsafe {{}} {condition} }};"
        ))
    })
}

/// A postcondition: a closure from a reference to the result to `bool`.
#[proc_macro_attribute]
pub fn ensures(condition: TokenStream, item: TokenStream) -> TokenStream {
    at_start_of_body(item, |result| {
        parse(&format!(
            "#[allow(unused_variables, unused_parens)]
             let ensures = |kani_result: &{result}| -> bool {{
                 unsafe {{}}
                 kani::internal::apply_closure({condition}, kani_result)
             }};"
        ))
    })
}

/// The item with a statement before its first one. `statement` gets the type that the function returns.
fn at_start_of_body(item: TokenStream, statement: impl FnOnce(&str) -> TokenStream) -> TokenStream {
    let mut tokens: Vec<TokenTree> = item.into_iter().collect();
    let Some(TokenTree::Group(body)) = tokens.pop() else { return error("this attribute is for functions") };
    if body.delimiter() != Delimiter::Brace {
        return error("this attribute is for functions with a body");
    }
    let result = return_type(&tokens);
    let mut statements = statement(&result);
    statements.extend(body.stream());
    let mut new = Group::new(Delimiter::Brace, statements);
    new.set_span(body.span());
    tokens.push(TokenTree::Group(new));
    tokens.into_iter().collect()
}

/// What stands between the last `->` outside brackets and the body or `where`; `()` if there is none.
fn return_type(signature: &[TokenTree]) -> String {
    let is = |token: &TokenTree, sign: char| matches!(token, TokenTree::Punct(punct) if punct.as_char() == sign);
    let arrow = signature.windows(2).rposition(|pair| is(&pair[0], '-') && is(&pair[1], '>'));
    let Some(arrow) = arrow else { return "()".into() };
    let is_where = |token: &&TokenTree| matches!(token, TokenTree::Ident(word) if word.to_string() == "where");
    signature[arrow + 2..].iter().take_while(|token| !is_where(token)).cloned().collect::<TokenStream>().to_string()
}

fn with_attribute(attribute: &str, item: TokenStream) -> TokenStream {
    let mut tokens = parse(attribute);
    tokens.extend(item);
    tokens
}

fn parse(code: &str) -> TokenStream {
    code.parse().unwrap_or_else(|_| error("the condition does not parse"))
}

fn error(message: &str) -> TokenStream {
    format!("compile_error!({message:?});").parse().unwrap_or_default()
}
