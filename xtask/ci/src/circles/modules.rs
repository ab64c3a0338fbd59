//! The modules of one crate, what each names, and which file defines a name.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ExprLit, Item, ItemMod, ItemUse, Lit, LitStr, Macro, Meta, UseTree, Visibility};

/// Segments of a path.
type Segments = Vec<String>;

/// A crate as its files declare it.
#[derive(Debug, Default)]
pub struct Crate {
    /// The files, the root first.
    pub files: Vec<PathBuf>,
    modules: Vec<Module>,
}

#[derive(Debug, Default)]
struct Module {
    file: usize,
    parent: usize,
    /// Names that stand in the module.
    names: Vec<(String, Named)>,
    /// What is imported by `*`.
    globs: Vec<Segments>,
    /// Paths in its code, private imports among them.
    paths: BTreeSet<Segments>,
}

#[derive(Debug, Clone)]
enum Named {
    /// Defined in this file.
    Item,
    /// A module below.
    Module(usize),
    /// Imported by this path.
    Import(Segments),
}

/// What a path leads to.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Found {
    /// Something defined in this file.
    In(usize),
    Module(usize),
    /// Something of another crate.
    Outside,
}

/// The names that are being looked up, each in its module.
type Asked = Vec<(usize, String)>;

impl Crate {
    /// Reads the file and all modules that it declares, those of tests among them.
    pub fn read(root: &Path) -> Crate {
        let mut read = Crate::default();
        read.file(root, 0, true);
        read
    }

    /// Reads a file as the next module and returns the number of the module. A root declares modules in its own folder.
    fn file(&mut self, path: &Path, parent: usize, is_root: bool) -> usize {
        let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let tree = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let folder = path.parent().unwrap();
        let below = if is_root || path.ends_with("mod.rs") { folder.into() } else { path.with_extension("") };
        self.files.push(path.to_owned());
        let file = self.files.len() - 1;
        self.module(&tree.items, Place { file, parent, folder, below: &below })
    }

    fn module(&mut self, items: &[Item], place: Place) -> usize {
        let number = self.modules.len();
        self.modules.push(Module { file: place.file, parent: place.parent, ..Module::default() });
        let mut reader = Reader { read: self, module: number, place };
        for item in items {
            if let Some(name) = name_of(item) {
                reader.name(name, Named::Item);
            }
            reader.visit_item(item);
        }
        number
    }

    /// Which file uses which other one.
    pub fn uses(&self) -> BTreeSet<(usize, usize)> {
        let mut uses = BTreeSet::new();
        for (number, module) in self.modules.iter().enumerate() {
            for path in module.paths.iter().chain(&module.globs) {
                for found in self.resolve(number, path, false, &mut Vec::new()) {
                    // what is named through an imported module is a path of its own
                    if let Found::In(file) = found
                        && file != module.file
                    {
                        uses.insert((module.file, file));
                    }
                }
            }
        }
        uses
    }

    /// What a path in a module leads to: an item and a module may have the same name. Nothing, if it begins outside of the crate.
    /// `inside` says whether the path so far has led into the module, where it then must be defined.
    fn resolve(&self, module: usize, path: &[String], inside: bool, within: &mut Asked) -> Vec<Found> {
        let Some((first, rest)) = path.split_first() else { return vec![Found::Module(module)] };
        let own = &self.modules[module];
        match first.as_str() {
            "crate" => self.resolve(0, rest, true, within),
            "self" => self.resolve(module, rest, true, within),
            "super" => self.resolve(own.parent, rest, true, within),
            name => {
                let mut found = self.look_up(module, name, within);
                if found.is_empty() && inside {
                    // made by a macro
                    found.push(Found::In(own.file));
                }
                // only a module or a type can stand before a further segment, not a function of the same name
                if !rest.is_empty() && found.iter().any(|one| matches!(one, Found::Module(_))) {
                    found.retain(|one| matches!(one, Found::Module(_)));
                }
                let follow = |found| match found {
                    Found::Module(module) => self.resolve(module, rest, true, within),
                    // a variant or an associated item stands where its type does
                    Found::In(_) | Found::Outside => vec![found],
                };
                found.into_iter().flat_map(follow).collect()
            }
        }
    }

    /// What a name that stands in a module means; imports are followed to where the item is defined.
    fn look_up(&self, module: usize, name: &str, within: &mut Asked) -> Vec<Found> {
        let asked = (module, name.to_owned());
        // an item may have the name of the crate that it is imported from
        if within.contains(&asked) {
            return Vec::new();
        }
        within.push(asked);
        let own = &self.modules[module];
        let mut found = Vec::new();
        for (_, named) in own.names.iter().filter(|(own, _)| own == name) {
            match named {
                Named::Item => found.push(Found::In(own.file)),
                Named::Module(below) => found.push(Found::Module(*below)),
                Named::Import(path) => match self.resolve(module, path, false, within) {
                    none if none.is_empty() => found.push(Found::Outside),
                    some => found.extend(some),
                },
            }
        }
        if found.is_empty() {
            for glob in &own.globs {
                for one in self.resolve(module, glob, false, within) {
                    if let Found::Module(other) = one {
                        found.extend(self.look_up(other, name, within));
                    }
                }
            }
        }
        within.pop();
        found
    }
}

/// Where a module stands.
#[derive(Clone, Copy)]
struct Place<'a> {
    file: usize,
    /// The module around it.
    parent: usize,
    /// The folder of its file, from which `path` attributes start.
    folder: &'a Path,
    /// The folder of the modules that it declares.
    below: &'a Path,
}

struct Reader<'a> {
    read: &'a mut Crate,
    module: usize,
    place: Place<'a>,
}

impl Reader<'_> {
    fn own(&mut self) -> &mut Module {
        &mut self.read.modules[self.module]
    }

    fn name(&mut self, name: String, named: Named) {
        self.own().names.push((name, named));
    }

    /// Takes in an import; what is only passed on is not yet used.
    fn import(&mut self, tree: &UseTree, before: &[String], passed_on: bool) {
        let with = |name: String| [before, &[name]].concat();
        let (path, name) = match tree {
            UseTree::Path(path) => return self.import(&path.tree, &with(path.ident.to_string()), passed_on),
            UseTree::Group(group) => return group.items.iter().for_each(|tree| self.import(tree, before, passed_on)),
            UseTree::Glob(_) => return self.own().globs.push(before.to_vec()),
            UseTree::Name(name) if name.ident == "self" => {
                (before.to_vec(), before.last().cloned().unwrap_or_default())
            }
            UseTree::Name(name) => (with(name.ident.to_string()), name.ident.to_string()),
            UseTree::Rename(new) if new.ident == "self" => (before.to_vec(), new.rename.to_string()),
            UseTree::Rename(new) => (with(new.ident.to_string()), new.rename.to_string()),
        };
        if !passed_on {
            self.own().paths.insert(path.clone());
        }
        self.name(name, Named::Import(path));
    }

    /// Finds paths among tokens that are not parsed.
    fn tokens(&mut self, tokens: TokenStream) {
        let mut path: Segments = Vec::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Punct(punct) if punct.as_char() == ':' && !path.is_empty() => {
                    colons += 1;
                    continue;
                }
                TokenTree::Ident(name) if colons == 2 => path.push(name.to_string()),
                token => {
                    self.path(std::mem::take(&mut path));
                    match token {
                        TokenTree::Ident(name) => path.push(name.to_string()),
                        TokenTree::Group(group) => self.tokens(group.stream()),
                        TokenTree::Literal(text) => self.quoted(&text.to_string()),
                        TokenTree::Punct(_) => {}
                    }
                }
            }
            colons = 0;
        }
        self.path(path);
    }

    /// Takes in a path that stands in quotes, as derives have it.
    fn quoted(&mut self, text: &str) {
        let path = syn::parse_str::<LitStr>(text).and_then(|text| text.parse::<syn::Path>());
        if let Ok(path) = path {
            self.visit_path(&path);
        }
    }

    fn path(&mut self, path: Segments) {
        if !path.is_empty() {
            self.own().paths.insert(path);
        }
    }

    fn declared(&mut self, item: &ItemMod) {
        let name = item.ident.to_string();
        let below = self.place.below.join(&name);
        let place = Place { parent: self.module, below: &below, ..self.place };
        let number = match &item.content {
            Some((_, items)) => self.read.module(items, place),
            None => {
                let stated = item.attrs.iter().find_map(path_of);
                let candidates = match &stated {
                    Some(path) => vec![place.folder.join(path)],
                    None => vec![below.with_extension("rs"), below.join("mod.rs")],
                };
                let path = candidates.iter().find(|path| path.is_file());
                let path = path.unwrap_or_else(|| panic!("no file of the module {name} among {candidates:?}"));
                self.read.file(path, self.module, stated.is_some())
            }
        };
        self.name(name, Named::Module(number));
    }
}

impl Visit<'_> for Reader<'_> {
    fn visit_item_mod(&mut self, item: &ItemMod) {
        self.declared(item);
    }

    fn visit_item_use(&mut self, item: &ItemUse) {
        self.import(&item.tree, &[], !matches!(item.vis, Visibility::Inherited));
    }

    /// `pub(in path)` uses nothing.
    fn visit_visibility(&mut self, _: &Visibility) {}

    fn visit_path(&mut self, path: &syn::Path) {
        self.path(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &Macro) {
        self.visit_path(&call.path);
        self.tokens(call.tokens.clone());
    }

    /// Derives take paths, also as text.
    fn visit_attribute(&mut self, attribute: &Attribute) {
        if let Meta::List(list) = &attribute.meta {
            self.tokens(list.tokens.clone());
        }
    }
}

/// The path of an attribute `path`.
fn path_of(attribute: &Attribute) -> Option<String> {
    let Meta::NameValue(pair) = &attribute.meta else { return None };
    let Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) = &pair.value else { return None };
    pair.path.is_ident("path").then(|| text.value())
}

/// The name of an item that is defined where it stands.
fn name_of(item: &Item) -> Option<String> {
    let name = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Macro(item) => item.ident.as_ref()?,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        _ => return None,
    };
    Some(name.to_string())
}
