#!/usr/bin/env python3
"""Opens the example's pages in headless Chromium: layout at three widths, no script error, no request to anywhere,
sorting, large figures, links into folded parts, and a print.

    browser_test.py EXAMPLE_REPORT CHROMIUM
"""
import html
import json
import os
import re
import subprocess
import sys
import tempfile

FIRST = """<script>
window.faults = [];
addEventListener("error", (e) => faults.push("error: " + (e.message || e.target.tagName)), true);
addEventListener("unhandledrejection", (e) => faults.push("rejection: " + e.reason));
document.addEventListener("securitypolicyviolation", (e) => faults.push("outside: " + e.blockedURI));
</script>"""

LAST = """<script>
addEventListener("load", async () => {
  const found = {faults};
  const check = (name, good) => { if (!good) faults.push("failed: " + name); };
  const root = document.documentElement;
  found.overflow = root.scrollWidth - root.clientWidth;
  found.outside = performance.getEntriesByType("resource").map((e) => e.name).filter((n) => !n.startsWith("data:"));
  const pictures = document.querySelectorAll("figure img");   // the large view has none before it opens
  found.pictures = pictures.length;
  for (const image of pictures) check("picture " + image.alt, image.complete && image.naturalWidth > 100);
  for (const text of document.querySelectorAll("p, li, td")) {
    if (text.offsetParent && parseFloat(getComputedStyle(text).fontSize) < 11) { check("text too small", false); break; }
  }
  const table = document.querySelector("table.sortable");
  const column = table.tHead.rows[0].cells.length - 3;
  const values = () => Array.from(table.tBodies[0].rows, (r) => r.cells[column].dataset.value ?? r.cells[column].textContent);
  const before = values();
  const button = table.tHead.rows[0].cells[column].querySelector("button");
  const sorted = (v, sign) => v.every((x, i) => i === 0 || sign * (Number(x) - Number(v[i - 1])) >= 0);
  button.click();
  check("rises", sorted(values(), 1));
  check("says it rises", table.tHead.rows[0].cells[column].getAttribute("aria-sort") === "ascending");
  button.click();
  check("falls", sorted(values(), -1));
  check("keeps its rows", values().sort().join() === before.sort().join());
  for (const image of pictures) if (image.offsetParent) check("figure's text too small", image.clientWidth >= 480);
  document.querySelector("figure button").click();
  const dialog = document.querySelector("dialog");
  if (innerWidth >= 1280)
    for (const box of document.querySelectorAll(".scroll"))
      if (box.offsetParent) check("table cut off: " + box.ariaLabel, box.scrollWidth <= box.clientWidth);
  check("opens large", dialog.open && dialog.querySelector("img").src.startsWith("data:image/png"));
  const large = dialog.querySelector("img");
  if (!large.complete) await new Promise((loaded) => large.addEventListener("load", loaded));
  check("as large as it is", large.naturalWidth > 100 && large.clientWidth === large.naturalWidth);
  dialog.click();
  check("closes", !dialog.open);
  const wave = document.querySelector("tr[id*='-wave-']");
  if (wave) {
    check("folded at first", !wave.closest("details").open);
    location.hash = wave.id;
    setTimeout(() => { check("unfolds", wave.closest("details").open); root.dataset.found = JSON.stringify(found); }, 50);
  } else {
    root.dataset.found = JSON.stringify(found);
  }
});
</script>"""


def chromium(program, profile, *arguments):
    return subprocess.run(
        [program, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", f"--user-data-dir={profile}", "--hide-scrollbars",
         "--host-resolver-rules=MAP * ~NOTFOUND", "--virtual-time-budget=4000", *arguments],
        capture_output=True, text=True, timeout=240, check=False).stdout


def main():
    example, program = sys.argv[1:3]
    problems = []
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        subprocess.run([example, folder], check=True)
        for page in ("report.html", "compare.html"):
            with open(os.path.join(folder, page), encoding="utf-8") as file:
                text = file.read()
            probed = os.path.join(folder, "probed-" + page)
            with open(probed, "w", encoding="utf-8") as file:
                file.write(text.replace("<head>", "<head>" + FIRST, 1).replace("</body>", LAST + "</body>", 1))
            for width in (1280, 800, 390):
                # Chromium's own window does not get narrower than 500 pixels: a frame does.
                framed = os.path.join(folder, f"{width}-{page}")
                with open(framed, "w", encoding="utf-8") as file:
                    file.write(f"<body style='margin:0'><iframe style='border:0;width:{width}px;height:900px' src='probed-{page}'></iframe>"
                               "<script>setInterval(() => { const d = frames[0].document.documentElement.dataset.found;"
                               " if (d) document.documentElement.dataset.found = d; }, 20)</script></body>")
                dom = chromium(program, os.path.join(folder, "profile"), "--allow-file-access-from-files", f"--window-size={max(width, 500)},900", "--dump-dom",
                               "file://" + framed)
                match = re.search(r'<html[^>]* data-found="([^"]*)"', dom)
                if not match:
                    problems.append(f"{page} at {width}: the page did not answer")
                    continue
                found = json.loads(html.unescape(match.group(1)))
                problems += [f"{page} at {width}: {fault}" for fault in found["faults"]]
                if found["overflow"] > 0:
                    problems.append(f"{page} at {width}: {found['overflow']} pixels too wide")
                problems += [f"{page} at {width}: asks {name}" for name in found["outside"]]
                if found["pictures"] < 4:
                    problems.append(f"{page} at {width}: {found['pictures']} pictures")
            pdf = os.path.join(folder, page + ".pdf")
            chromium(program, os.path.join(folder, "profile"), f"--print-to-pdf={pdf}", "file://" + os.path.join(folder, page))
            if not os.path.exists(pdf) or os.path.getsize(pdf) < 20000:
                problems.append(f"{page}: does not print")
    for problem in problems:
        print(problem)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
