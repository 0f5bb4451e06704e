// A cell that holds a sentence is given room for a few words a line; a style sheet cannot count them.
for (const cell of document.querySelectorAll("td:not(.linenos)")) {
  cell.classList.toggle("sentence", cell.textContent.trim().split(/\s+/).length > 5);
}
