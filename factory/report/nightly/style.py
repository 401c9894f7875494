"""How the pages look, in daylight and at night."""

from string import Template

STYLE = """
:root { --ink: #1c2024; --dim: #5c6670; --line: #dfe3e8; --ground: #ffffff; --raised: #f6f7f9; --accent: #2765c4;
  --passed: #2f8f4e; --rejected: #c23b32; --unjudged: #c98a12; --mark: #5b8ad6; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6e9ec; --dim: #98a2ac; --line: #33393f; --ground: #15181b; --raised: #1e2226; --accent: #86b2f2;
    --passed: #58b878; --rejected: #ec7a70; --unjudged: #e2b04a; --mark: #6f9ce0; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2rem 1.25rem 4rem; max-width: 70rem; background: var(--ground); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; color-scheme: light dark; }
h1 { font-size: 1.6rem; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.1rem; margin: 2.5rem 0 .6rem; }
p { margin: .4rem 0; max-width: 50rem; }
a { color: var(--accent); text-decoration: none; }
a:hover { text-decoration: underline; }
code { font: .92em ui-monospace, "SF Mono", Consolas, monospace; overflow-wrap: anywhere; }
nav { color: var(--dim); margin-bottom: .5rem; }
.dim, .dim a { color: var(--dim); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(8.5rem, 1fr)); gap: .75rem; margin: 1.25rem 0; }
.tile { background: var(--raised); border-radius: 8px; padding: .7rem .9rem; }
.tile b { display: block; font-size: 1.5rem; line-height: 1.25; font-weight: 600; white-space: nowrap; }
.tile span { display: block; font-size: .85rem; color: var(--dim); }
.attention, .well { border-left: 4px solid var(--unjudged); background: var(--raised); border-radius: 0 8px 8px 0;
  padding: .6rem 1rem; margin: 1rem 0; }
.attention.bad { border-color: var(--rejected); }
.well { border-color: var(--passed); }
.attention ul { margin: .2rem 0; padding-left: 1.1rem; }
.scroll { overflow-x: auto; }
.scroll + .scroll { margin-top: 1.4rem; }
table { border-collapse: collapse; width: 100%; font-size: .9rem; }
th { text-align: left; font-weight: 600; color: var(--dim); border-bottom: 1px solid var(--line); white-space: nowrap; }
th, td { padding: .32rem 1rem .32rem 0; vertical-align: top; }
td { border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
td.number, th.number { text-align: right; white-space: nowrap; font-variant-numeric: tabular-nums; }
td.short { white-space: nowrap; }
td.name { min-width: 11rem; }
td.sentence { min-width: 16rem; }
.passed { color: var(--passed); } .rejected { color: var(--rejected); } .unjudged { color: var(--unjudged); }
details { margin: .5rem 0; }
summary { cursor: pointer; color: var(--accent); }
svg { display: block; width: 100%; max-width: 48rem; height: auto; margin: .5rem 0; }
svg text { font: 12px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; fill: var(--dim); }
svg text.strong { fill: var(--ink); font-weight: 600; }
svg .grid { stroke: var(--line); stroke-width: 1; }
svg .curve { fill: none; stroke: var(--accent); stroke-width: 2; stroke-linejoin: round; }
svg .dot { fill: var(--accent); stroke: var(--ground); stroke-width: 1.5; }
svg .bar { fill: var(--mark); }
svg .bar.passed { fill: var(--passed); } svg .bar.rejected { fill: var(--rejected); }
svg .bar.unjudged { fill: var(--unjudged); }
footer { margin-top: 3rem; padding-top: .8rem; border-top: 1px solid var(--line);
  color: var(--dim); font-size: .85rem; }
"""

DOCUMENT = Template("""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<title>$title</title>
<style>$style</style>
</head>
<body>
$body
</body>
</html>
""")
