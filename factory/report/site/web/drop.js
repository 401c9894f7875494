// Files that are dropped on the page of `factory view`: its server shows them in place of what it shows.

/** Names and files of a drop, folders with all that is in them. */
async function filesOf(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry()).filter(Boolean);
  if (!entries.length) return [...transfer.files].map((file) => [file.name, file]);
  const found = [];
  const asked = (ask) => new Promise(ask);
  const walk = async (entry) => {
    if (entry.isFile) {
      found.push([entry.fullPath.replace(/^\//, ""), await asked((done, failed) => entry.file(done, failed))]);
      return;
    }
    const reader = entry.createReader();
    for (;;) {
      // A reader gives a hundred at a time.
      const part = await asked((done, failed) => reader.readEntries(done, failed));
      if (!part.length) return;
      for (const each of part) await walk(each);
    }
  };
  for (const entry of entries) await walk(entry);
  return found;
}

/** Take drops anywhere on the page; `note` says what becomes of them. */
export function takeDrops(note) {
  const tell = (text, bad = false) => {
    note.textContent = text;
    note.classList.toggle("bad", bad);
  };
  const hovered = (over) => document.body.classList.toggle("dropping", over);
  document.addEventListener("dragover", (event) => { event.preventDefault(); hovered(true); });
  document.addEventListener("dragleave", (event) => { if (!event.relatedTarget) hovered(false); });
  document.addEventListener("drop", async (event) => {
    event.preventDefault();
    hovered(false);
    try {
      const files = await filesOf(event.dataTransfer);
      tell(`Reading ${files.length === 1 ? files[0][0] : `${files.length} files`} ...`);
      const head = JSON.stringify(files.map(([name, file]) => [name, file.size]));
      const body = new Blob([head, "\n", ...files.map(([, file]) => file)]);
      const answer = await fetch("/drop", { method: "POST", body });
      if (!answer.ok) return tell(await answer.text() || "That is too much for the server.", true);
      history.replaceState(null, "", location.pathname);
      location.reload();
    } catch (error) {
      tell(`The server did not take it: ${error.message}`, true);
    }
  });
}
