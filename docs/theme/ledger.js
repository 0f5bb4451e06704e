// The filters of the ledger: a row is shown if it has what each of them asks for.
const table = document.getElementById("ledger");
if (table) {
  const rows = [...table.tBodies[0].rows];
  const filters = [...document.querySelectorAll("[data-filter]")];
  const shown = document.getElementById("shown");
  const texts = new Map(rows.map((row) => [row, row.textContent.toLowerCase()]));
  const has = (row, { dataset: { filter }, value }) =>
    filter === "words" ? value.toLowerCase().split(/\s+/).every((word) => texts.get(row).includes(word))
    : filter === "scheme" ? !value || row.dataset.scheme.split(" ").includes(value)
    : !value || row.dataset[filter] === value;
  const update = () => {
    let count = 0;
    for (const row of rows) {
      row.hidden = !filters.every((filter) => has(row, filter));
      count += !row.hidden;
    }
    shown.textContent = `${count} of ${rows.length}`;
  };
  filters.forEach((filter) => filter.addEventListener("input", update));
  update();
}
