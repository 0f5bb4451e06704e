"""The scenes of the study, and the items of the documents that each makes: `fracparticles scenes`."""

from __future__ import annotations

from pathlib import Path

from fracparticles.errors import InvalidInput, one_of

__all__ = ["listed", "scenes"]


def scenes(document: str | None = None) -> None:
    """List the scenes: name (the target of snakemake), title, and items of the document.

    Parameters
    ----------
    document : str
        Only the scenes of this document, for example lucchesi.
    """
    print("\n".join(listed(Path.cwd(), document)))


def listed(project: Path, document: str | None = None) -> list[str]:
    """Return the lines of the list for the project in a folder; raises `InvalidInput` if it holds none."""
    from fracstudy.config import CONFIG, read_project  # heavy, and --help does not need it

    if not (project / CONFIG).is_file():
        found = f"a folder that holds {CONFIG}"
        raise InvalidInput("folder", str(project), found, "Change to the folder of the study.")
    study, every = read_project(project)
    if document is not None and document not in study.documents:
        remedy = "Choose one of these, or leave it out."
        raise one_of("document", document, list(study.documents), remedy=remedy)
    width, lines = max(map(len, every)), []
    for name, entry in study.documents.items():
        if document not in (None, name):
            continue
        lines += ["", f"{entry.title} ({name})"]
        lines += [
            f"  {scene.name:{width}}  {scene.heading}"
            + (f" [{', '.join(scene.items)}]" if scene.items else "")
            for scene in every.values()
            if scene.document == name
        ]
    return lines[1:]
