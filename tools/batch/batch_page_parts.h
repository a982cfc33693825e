// What every batch page has in common: its style, and the script that sorts.
#pragma once

namespace gim {

inline constexpr const char* kBatchStyle = R"css(
:root { color-scheme: light dark; --ink: #1b1f23; --pale: #57606a; --line: #d0d7de; --ground: #ffffff; --bad: #b3261e;
  --gim: #0b62c4; --mcgim: #9a4d00; --tiles: #14743a; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e8ea; --pale: #a0a8b0; --line: #3a4149; --ground: #14171a;
  --bad: #ff8a80; --gim: #79b8ff; --mcgim: #ffb067; --tiles: #6fdc95; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1rem; max-width: 75rem; background: var(--ground); color: var(--ink);
  font: 1rem/1.45 system-ui, sans-serif; }
h1 { font-size: 1.4rem; } h2 { font-size: 1.15rem; margin-top: 2rem; }
code { overflow-wrap: anywhere; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.2rem 1rem; margin: 0; }
dt { color: var(--pale); } dd { margin: 0; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; }
th, td { padding: 0.3rem 0.6rem; border-bottom: 1px solid var(--line); text-align: right; vertical-align: middle; }
th:first-child, td:first-child, .text { text-align: left; }
td.name { overflow-wrap: anywhere; min-width: 9rem; }
th button { all: unset; cursor: pointer; font-weight: 600; }
th button:focus-visible { outline: 2px solid var(--gim); }
th[aria-sort=ascending] button::after { content: " \25B2"; } th[aria-sort=descending] button::after { content: " \25BC"; }
img { display: block; width: 4rem; height: 4rem; object-fit: contain; border-radius: 0.3rem; }
.failed { color: var(--bad); }
li { overflow-wrap: anywhere; }
svg { width: 100%; max-width: 34rem; height: auto; } svg text { fill: var(--ink); font: 13px system-ui, sans-serif; }
svg .axis { stroke: var(--pale); } svg .grid { stroke: var(--line); }
.gim { fill: var(--gim); } .mcgim { fill: var(--mcgim); } .tiles { fill: var(--tiles); }
@media (max-width: 40rem) {
  thead { position: absolute; left: -100vw; }
  tr { display: grid; grid-template-columns: 4rem 1fr; gap: 0 0.8rem; padding: 0.5rem 0; border-bottom: 1px solid var(--line); }
  td { border: 0; padding: 0; text-align: left; grid-column: 2; }
  td.picture { grid-column: 1; grid-row: 1 / span 8; }
  td[data-label]::before { content: attr(data-label) ": "; color: var(--pale); }
  td:empty { display: none; }
}
)css";

inline constexpr const char* kBatchScript = R"js(
const body = document.querySelector("#files tbody");
const heads = [...document.querySelectorAll("#files th")];
const key = (row, column) => row.cells[column].dataset.key ?? row.cells[column].textContent;
for (const head of heads) head.querySelector("button")?.addEventListener("click", () => {
  const column = heads.indexOf(head);
  const down = head.getAttribute("aria-sort") === "ascending";
  for (const other of heads) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", down ? "descending" : "ascending");
  const numbers = head.dataset.kind === "number";
  const compare = (a, b) => numbers ? Number(key(a, column)) - Number(key(b, column)) : key(a, column).localeCompare(key(b, column));
  body.append(...[...body.rows].sort((a, b) => down ? compare(b, a) : compare(a, b)));
});
)js";

}  // namespace gim
