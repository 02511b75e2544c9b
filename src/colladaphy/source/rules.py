"""What can be wrong with an input before its content is looked at, and with an output."""

from __future__ import annotations

from colladaphy.findings import Rule, Severity

__all__ = ["RULES", "UNREACHABLE"]

_ERROR = Severity.ERROR
_WARNING = Severity.WARNING
_INFO = Severity.INFO

MISSING = Rule(
    "io-missing",
    _ERROR,
    "The file does not exist.",
    "Check the spelling and the folder.",
    section="colladaphy docs/validate.md",
    why="There is nothing to read.",
)
FOLDER = Rule(
    "io-folder",
    _ERROR,
    "This is a folder, not a file.",
    "Name a .dae or .zae file in it.",
    section="colladaphy docs/validate.md",
    why="There is nothing to read.",
)
UNREADABLE = Rule(
    "io-unreadable",
    _ERROR,
    "The input cannot be read.",
    "Check that the file exists, that you may read it, and that its disk is there.",
    section="colladaphy docs/validate.md",
    why="There is nothing to read.",
)
NOT_BINARY = Rule(
    "io-not-binary",
    _ERROR,
    "The input gives text where bytes are needed.",
    "Open the file in binary mode ('rb'), or encode the text.",
    section="colladaphy.read",
    why="The document itself says which encoding it has; text has lost it.",
)
TOO_LARGE = Rule(
    "io-too-large",
    _ERROR,
    "The input is larger than the limit.",
    "If the file is trusted, raise the limit with Limits(bytes=...) or --limit bytes=N.",
    section="colladaphy.Limits",
    why="A file that nobody expects so large can fill the memory.",
)
ARCHIVE_BROKEN = Rule(
    "io-archive-broken",
    _ERROR,
    "The archive is damaged, encrypted, or packed in a way that is not supported.",
    "Pack the document again as a plain zip archive.",
    section="COLLADA 1.5 §Archive packaging (.zae)",
    why="What cannot be unpacked cannot be read.",
)
ARCHIVE_UNSAFE = Rule(
    "io-archive-unsafe",
    _ERROR,
    "The archive has an entry that a .zae must not have.",
    "Pack only plain files, each once, under relative names without '..'.",
    "COLLADA 1.5 §Archive packaging (.zae)",
    why="An entry could be written over a file outside, or hide another one.",
)
ARCHIVE_BOMB = Rule(
    "io-archive-bomb",
    _ERROR,
    "The archive unpacks to more than the limits allow.",
    "If the file is trusted, raise archive_ratio, archive_entries or total in Limits or --limit.",
    section="colladaphy.Limits",
    why="A small archive can unpack to more than any memory holds.",
)
ARCHIVE_ROOT = Rule(
    "io-archive-root",
    _ERROR,
    "The archive does not say which of its files is the document.",
    "Add a manifest.xml with <dae_root>name.dae</dae_root>, or pack exactly one .dae file.",
    "COLLADA 1.5 §Archive packaging (.zae)",
    why="Which of the files is meant would be a guess.",
)
REFERENCE_REFUSED = Rule(
    "io-reference-refused",
    _WARNING,
    "A reference to another file leads out of the document's folder or archive.",
    "Put the file next to the document and refer to it by a relative name.",
    section="COLLADA 1.5 §Address syntax",
    why="A document could reach for any file of the machine.",
)
REFERENCE_MISSING = Rule(
    "io-reference-missing",
    _WARNING,
    "A file that the document refers to does not exist.",
    "Put the file where the reference says, or correct the reference.",
    section="COLLADA 1.5 §Address syntax",
    why="What the file holds is missing wherever the document is used.",
)
COMPANION_TAKEN = Rule(
    "io-companion-taken",
    _INFO,
    "A file that the document refers to was written with it.",
    section="COLLADA 1.5 §Address syntax",
    why="Without it, the document would refer to nothing where it is now.",
)
MERGED = Rule(
    "io-companion-merged",
    _INFO,
    "A document that was referred to was brought into the one that refers to it.",
    section="colladaphy convert --merge",
    why="The document stands alone now.",
)
COMPANION_LEFT = Rule(
    "io-companion-left",
    _WARNING,
    "A file that the document refers to was not written with it.",
    "Copy it by hand, or let it be replaced with --force.",
    section="COLLADA 1.5 §Address syntax",
    why="The document refers to nothing where it is now.",
)
OUTPUT_FAILED = Rule(
    "io-output-failed",
    _ERROR,
    "The output cannot be written.",
    "Choose another folder, or check its permissions and its disk.",
    section="colladaphy.write",
    why="The result is not saved; what was there before is untouched.",
)

EMPTY = Rule(
    "xml-empty",
    _ERROR,
    "The file is empty.",
    "Export the document again.",
    section="XML 1.0 §Well-formed XML documents",
    why="There is nothing to read.",
)
NOT_XML = Rule(
    "xml-not-xml",
    _ERROR,
    "The file is not XML.",
    "A COLLADA document begins with '<?xml' or '<COLLADA'; export it as .dae or .zae.",
    section="XML 1.0 §Well-formed XML documents",
    why="Nothing of it can be read as COLLADA.",
)
HTML = Rule(
    "xml-html",
    _ERROR,
    "The file is an HTML page, not a COLLADA document.",
    "Download the file itself (the 'raw' link), not the page that shows it.",
    section="XML 1.0 §Well-formed XML documents",
    why="A page about the document was saved in its place.",
)
DOCTYPE = Rule(
    "xml-doctype",
    _ERROR,
    "The document has a DOCTYPE, which is refused: it can name other files and entities.",
    "Remove the <!DOCTYPE ...> declaration; COLLADA needs none.",
    section="XML 1.0 §Document type declaration",
    why="Entities can read other files, or grow to any size.",
)
MALFORMED = Rule(
    "xml-malformed",
    _ERROR,
    "The document is not well-formed XML.",
    "Correct the markup at this place, or export the document again.",
    section="XML 1.0 §Well-formed XML documents",
    why="What follows could mean anything, so no parser goes on.",
)
ENCODING = Rule(
    "xml-encoding",
    _ERROR,
    "The document is not in the encoding that it declares.",
    "Save the document as UTF-8.",
    section="XML 1.0 §Character encoding in entities",
    why="Names and texts would be read as other characters.",
)
TRUNCATED = Rule(
    "xml-truncated",
    _ERROR,
    "The document ends before its last element is closed.",
    "The file was cut off: copy, download or export it again.",
    section="XML 1.0 §Well-formed XML documents",
    why="The rest of the document is lost.",
)
TRAILING = Rule(
    "xml-trailing",
    _ERROR,
    "There is content after the end of the document.",
    "Remove what follows </COLLADA>.",
    section="XML 1.0 §Well-formed XML documents",
    why="Two documents may have been written into one file.",
)
TOO_DEEP = Rule(
    "xml-too-deep",
    _ERROR,
    "Elements are nested deeper than the limit.",
    "If the file is trusted, raise the limit with Limits(depth=...) or --limit depth=N.",
    section="colladaphy.Limits",
    why="Every program that walks through it needs a level of its stack for each.",
)
TEXT_TOO_LONG = Rule(
    "xml-text-too-long",
    _ERROR,
    "A text, a name or an attribute is longer than the limit.",
    "If the file is trusted, raise the limit with Limits(text=...) or --limit text=N.",
    section="colladaphy.Limits",
    why="A single text can fill the memory.",
)
TOO_MANY_ELEMENTS = Rule(
    "xml-too-many-elements",
    _ERROR,
    "The document has more elements than the limit.",
    "If the file is trusted, raise the limit with Limits(elements=...) or --limit elements=N.",
    section="colladaphy.Limits",
    why="A tree takes many times the memory of its file.",
)
LATIN = Rule(
    "repair-encoding",
    _WARNING,
    "Bytes are not in the encoding that the document states.",
    "Save the file as UTF-8, or state its encoding.",
    section="XML 1.0 §Character encoding in entities",
    why="No parser reads such a file.",
)
PREFIX = Rule(
    "repair-undeclared-prefix",
    _WARNING,
    "A prefix has no namespace.",
    "Declare it with xmlns:prefix=... where it begins; programs that save a file may drop it.",
    section="Namespaces in XML 1.0 §Declaring namespaces",
    why="No parser reads such a file.",
)
WRONG_ROOT = Rule(
    "xml-wrong-root",
    _ERROR,
    "The root element is not COLLADA.",
    "Choose a COLLADA document; other formats must be converted first.",
    "COLLADA 1.5 §COLLADA",
    why="Nothing of it can be read as COLLADA.",
)
WRONG_NAMESPACE = Rule(
    "xml-wrong-namespace",
    _ERROR,
    "The root element is not in a namespace of COLLADA.",
    'COLLADA 1.5 has xmlns="http://www.collada.org/2008/03/COLLADASchema".',
    "COLLADA 1.5 §COLLADA",
    why="Programs tell by the namespace what they can read.",
)

UNREACHABLE = frozenset({REFERENCE_REFUSED.code, REFERENCE_MISSING.code})
"""Of files that a document refers to: what they hold is left out, all else is as it was."""

EXTENSION_BROKEN = Rule(
    "config-extension-broken",
    _WARNING,
    "Something that another package offers to colladaphy cannot be used.",
    "Ask the package that offers it, or uninstall it.",
    section="colladaphy docs/engines.md §Engines of your own",
    why="What the package should do is not done.",
)

RULES = (
    EXTENSION_BROKEN,
    MISSING,
    FOLDER,
    UNREADABLE,
    NOT_BINARY,
    TOO_LARGE,
    ARCHIVE_BROKEN,
    ARCHIVE_UNSAFE,
    ARCHIVE_BOMB,
    ARCHIVE_ROOT,
    REFERENCE_REFUSED,
    REFERENCE_MISSING,
    COMPANION_TAKEN,
    MERGED,
    COMPANION_LEFT,
    OUTPUT_FAILED,
    EMPTY,
    NOT_XML,
    HTML,
    DOCTYPE,
    MALFORMED,
    ENCODING,
    TRUNCATED,
    TRAILING,
    TOO_DEEP,
    TEXT_TOO_LONG,
    TOO_MANY_ELEMENTS,
    LATIN,
    PREFIX,
    WRONG_ROOT,
    WRONG_NAMESPACE,
)
