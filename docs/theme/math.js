// Typesets the formulas of a page with the copy of KaTeX beside this file, without any network. Formulas are written as
// GitHub reads them too: a block as a fence named `math`, a formula in a line as $`...`$, which Markdown leaves alone.
(() => {
  const typeset = (formula, target, displayMode) => {
    katex.render(formula, target, { displayMode, throwOnError: true });
  };
  document.querySelectorAll("pre > code.language-math").forEach((code) => {
    const block = document.createElement("div");
    block.className = "math-block";
    typeset(code.textContent, block, true);
    code.parentElement.replaceWith(block);
  });
  document.querySelectorAll("code").forEach((code) => {
    const [before, after] = [code.previousSibling, code.nextSibling];
    const text = (node) => node !== null && node.nodeType === Node.TEXT_NODE;
    if (!text(before) || !text(after) || !before.data.endsWith("$") || !after.data.startsWith("$")) return;
    const line = document.createElement("span");
    typeset(code.textContent, line, false);
    before.data = before.data.slice(0, -1);
    after.data = after.data.slice(1);
    code.replaceWith(line);
  });
})();
