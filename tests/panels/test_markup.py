"""Whatever comes from outside cannot become markup."""

from html.parser import HTMLParser

from hypothesis import given, settings, strategies

from studio.panels import markup

words = strategies.text(alphabet=strategies.characters(codec="utf-8"), max_size=60)
PIECES = (
    markup.note,
    markup.problem,
    lambda text: markup.reasons([text]),
    lambda text: markup.table([text], [[text]]),
    lambda text: markup.pill("■", text, (0, 0, 0)),
)


class Reader(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.words = ""

    def handle_starttag(self, tag: str, attrs: list) -> None:
        self.tags.append(tag)

    def handle_data(self, data: str) -> None:
        self.words += data


def read(html: str) -> Reader:
    reader = Reader()
    reader.feed(html)
    reader.close()
    return reader


@given(words.filter(bool))
@settings(deadline=None, derandomize=True, max_examples=200)
def test_words_stay_words(text: str) -> None:
    for piece in PIECES:
        harmless, given_ = read(piece("x")), read(piece(text))
        assert given_.tags == harmless.tags
        assert text in given_.words


def test_no_reason_is_no_paragraph() -> None:
    assert markup.reasons(["", ""]) == ""
    assert markup.reasons(["one", "", "one"]).count("one") == 1


def test_a_table_lines_up_words_left_and_numbers_right() -> None:
    html = markup.table(("joint", "MSE"), [("left_s0", "1.0"), ("left_s1", "2.0")], bold=1)
    assert html.count("text-align:left") == html.count("text-align:right") == 3
    assert html.count("font-weight:700") == 2


def test_a_command_is_shown_as_it_is_typed_and_marked_by_one_click() -> None:
    shown = markup.command("studio play <FILE> --to ws://here:1")
    assert ">studio play &lt;FILE&gt; --to ws://here:1</code>" in shown
    assert "user-select:all" in shown
