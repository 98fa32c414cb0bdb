// Makes HTML pages of docs/, for the link Documents of the page: node scripts/documents.mjs FOLDER. vite.config.ts calls it for
// each build. A page needs no script and nothing from elsewhere.
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join, normalize, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { Marked } from "marked";

const root = fileURLToPath(new URL("../../../docs/", import.meta.url));

/** The parts of the documents, in the order in which a reader meets them. */
const parts = { start: "Start", use: "Use", reference: "Reference", theory: "Theory", inside: "Inside" };

const filesIn = (folder) =>
  readdirSync(join(root, folder), { withFileTypes: true })
    .flatMap((one) => (one.isDirectory() ? filesIn(`${folder}/${one.name}`) : [`${folder}/${one.name}`]))
    .filter((name) => name.endsWith(".md"))
    .sort();

const escaped = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");

/** The anchor that GitHub gives to a heading, since the documents link to those. */
const anchorOf = (text) =>
  text
    .toLowerCase()
    .replace(/<[^>]*>/g, "")
    .replace(/[^\p{L}\p{N}\s_-]/gu, "")
    .trim()
    .replace(/\s/g, "-");

const titleOf = (text) => /^# (.*)$/m.exec(text)?.[1] ?? "";

/** An address in a document, as seen from its HTML page; null: it leads to a file that is not served. */
function addressFrom(file, href, wantImage) {
  if (/^(https?:|mailto:|#)/.test(href)) return href;
  const [path, anchor] = href.split("#");
  const target = normalize(join(dirname(file), path));
  if (target.startsWith("..") || !existsSync(join(root, target))) return null;
  if (!wantImage && !target.endsWith(".md")) return null;
  return href.replace(/\.md(?=#|$)/, ".html") && `${path.replace(/\.md$/, ".html")}${anchor ? `#${anchor}` : ""}`;
}

function htmlOf(file, text, images) {
  const used = new Map();
  const marked = new Marked({ gfm: true });
  marked.use({
    renderer: {
      heading({ tokens, depth, text: plain }) {
        const base = anchorOf(plain.replaceAll("`", ""));
        const times = used.get(base) ?? 0;
        used.set(base, times + 1);
        const id = times === 0 ? base : `${base}-${times}`;
        return `<h${depth} id="${escaped(id)}">${this.parser.parseInline(tokens)}</h${depth}>\n`;
      },
      link({ href, tokens }) {
        const inside = this.parser.parseInline(tokens);
        const address = addressFrom(file, href, false);
        if (address === null) return inside;
        const elsewhere = /^https?:/.test(address) ? ' target="_blank" rel="noreferrer"' : "";
        return `<a href="${escaped(address)}"${elsewhere}>${inside}</a>`;
      },
      image({ href, text: alt }) {
        const address = addressFrom(file, href, true);
        if (address === null) return escaped(alt);
        images.add(normalize(join(dirname(file), href)));
        return `<img src="${escaped(address)}" alt="${escaped(alt)}">`;
      },
      // A table may be wider than the page.
      table(token) {
        const row = (cells, tag) =>
          `<tr>${cells.map((one) => `<${tag}>${this.parser.parseInline(one.tokens)}</${tag}>`).join("")}</tr>`;
        const body = token.rows.map((cells) => row(cells, "td")).join("\n");
        return `<div class="table" tabindex="0"><table><thead>${row(token.header, "th")}</thead><tbody>${body}</tbody></table></div>\n`;
      },
      code({ text: code }) {
        return `<pre tabindex="0"><code>${escaped(code)}</code></pre>\n`;
      },
      // The documents contain no HTML; a comment stays out.
      html: () => "",
    },
  });
  return marked.parse(text);
}

const style = `:root { color-scheme: light dark; --text: #1c2430; --soft: #4d5866; --line: #d9dee5; --back: #fff; --code: #f3f5f8; --link: #14609f; }
@media (prefers-color-scheme: dark) {
  :root { --text: #e3e8ef; --soft: #a6b0bd; --line: #343c47; --back: #14181d; --code: #1d232a; --link: #7cb8f0; }
}
* { box-sizing: border-box; }
body { margin: 0; display: grid; grid-template-columns: 240px minmax(0, 1fr); font: 15px/1.55 system-ui, sans-serif; color: var(--text); background: var(--back); }
a { color: var(--link); }
nav { padding: 20px 16px; border-right: 1px solid var(--line); font-size: 14px; }
nav h2 { margin: 16px 0 4px; font-size: 13px; color: var(--soft); }
nav ul { margin: 0; padding: 0; list-style: none; }
nav li { padding: 2px 0; }
nav [aria-current] { font-weight: 650; color: var(--text); text-decoration: none; }
main { padding: 20px 32px 60px; max-width: 900px; min-width: 0; }
h1 { font-size: 26px; line-height: 1.25; } h2 { margin-top: 36px; font-size: 20px; } h3 { font-size: 16px; }
pre, .table { overflow-x: auto; }
pre { padding: 12px 14px; background: var(--code); border-radius: 6px; }
code { font: 13px/1.5 ui-monospace, monospace; overflow-wrap: break-word; }
:not(pre) > code { padding: 1px 4px; background: var(--code); border-radius: 4px; }
table { border-collapse: collapse; } th, td { padding: 5px 10px; border: 1px solid var(--line); text-align: left; vertical-align: top; }
img { max-width: 100%; border: 1px solid var(--line); border-radius: 6px; }
@media (max-width: 760px) { body { display: block; } nav { border-right: 0; border-bottom: 1px solid var(--line); } main { padding: 12px 16px 40px; } }
`;

function page(file, title, content, pages) {
  const up = relative(dirname(file), ".") || ".";
  const list = Object.entries(parts)
    .map(([folder, name]) => {
      const items = pages
        .filter((one) => dirname(one.file) === folder)
        .map((one) => {
          const here = one.file === file ? ' aria-current="page"' : "";
          return `<li><a href="${up}/${one.file.replace(/\.md$/, ".html")}"${here}>${escaped(one.title.replaceAll("`", ""))}</a></li>`;
        });
      return `<h2>${name}</h2><ul>${items.join("")}</ul>`;
    })
    .join("\n");
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${escaped(title)} - Tessera</title>
<link rel="stylesheet" href="${up}/style.css">
<body>
<nav aria-label="Documents"><a href="${up}/index.html">Tessera: documents</a>${list}</nav>
<main>
${content}</main>
</body>
</html>
`;
}

/** Writes the pages, and the pictures that they show, into a folder. */
export function writeDocuments(to) {
  const pages = Object.keys(parts)
    .flatMap(filesIn)
    .map((file) => ({ file, text: readFileSync(join(root, file), "utf8") }))
    .map((one) => ({ ...one, title: titleOf(one.text) }));
  const images = new Set();
  const write = (name, text) => {
    mkdirSync(dirname(join(to, name)), { recursive: true });
    writeFileSync(join(to, name), text);
  };
  for (const { file, text, title } of pages)
    write(file.replace(/\.md$/, ".html"), page(file, title, htmlOf(file, text, images), pages));
  const beginning = `<h1>Documents</h1>
<p>Begin with the <a href="start/tutorial.html">tutorial</a>, or with the <a href="start/studio_tour.html">tour of the studio</a>.
The <a href="reference/glossary.html">glossary</a> explains the terms.</p>
`;
  write("index.html", page("index.md", "Documents", beginning, pages));
  write("style.css", style);
  for (const image of images) cpSync(join(root, image), join(to, image));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) writeDocuments(process.argv[2] ?? "documents");
