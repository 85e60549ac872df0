// Folded parts: a link to a heading opens what is folded below it. On paper, parts marked "print" are open, too; the
// others are as the reader left them.
function unfold() {
  const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  if (!target) return;
  for (let part = target.nextElementSibling; part && part.tagName !== "H2"; part = part.nextElementSibling) {
    if (part.matches("details.fold")) { part.open = true; break; }
  }
  target.closest("details")?.setAttribute("open", "");
}
const more = document.querySelector("nav .more");
addEventListener("click", (event) => { if (!event.target.closest("nav summary")) more.open = false; });
addEventListener("hashchange", unfold);
unfold();
let before = [];
addEventListener("beforeprint", () => {
  before = [...document.querySelectorAll("details")].map((part) => [part, part.open]);
  for (const [part] of before) part.open ||= part.matches(".print");
});
addEventListener("afterprint", () => { for (const [part, open] of before) part.open = open; });
