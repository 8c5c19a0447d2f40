"""Stand-ins for viser's controls: they remember what panels set, and act when a test presses."""

from collections.abc import Callable
from types import SimpleNamespace

CLIENT = object()  # a person's browser


class Control:
    """Any control: a value, properties, and callbacks."""

    def __init__(self, label: str = "", value: object = None, **props: object) -> None:
        self.__dict__.update(
            label=label, value=value, told=[], disabled=False, visible=True, content=""
        )
        self.__dict__.update(props)
        self.__dict__["heard"] = []

    def __setattr__(self, name: str, value: object) -> None:
        self.told.append(name)
        self.__dict__[name] = value

    def on_click(self, act: Callable[..., None]) -> Callable[..., None]:
        self.heard.append(act)
        return act

    on_update = on_click

    def press(self, value: object = None) -> None:
        """Do what a person does: choose a value, or press."""
        if value is not None:
            self.__dict__["value"] = value
        for act in self.heard:
            act(SimpleNamespace(client=CLIENT))


class Gui:
    """Keeps every control by its label; texts without one in the order in which they came."""

    def __init__(self) -> None:
        self.by_label: dict[str, Control] = {}
        self.texts: list[Control] = []
        self.charts: list[Control] = []
        self.bars: list[Control] = []

    def add_button(self, label: str, **props: object) -> Control:
        return self._keep(Control(label, **props))

    def add_slider(self, label: str, initial_value: object, **props: object) -> Control:
        return self._keep(Control(label, initial_value, **props))

    def add_checkbox(self, label: str, initial_value: bool, **props: object) -> Control:
        return self._keep(Control(label, initial_value, **props))

    def add_dropdown(
        self, label: str, options: tuple, initial_value: object = None, **props: object
    ) -> Control:
        return self._keep(Control(label, initial_value or options[0], options=options, **props))

    def add_button_group(self, label: str, options: tuple, **props: object) -> Control:
        return self._keep(Control(label, options[0], options=options, **props))

    def add_html(self, content: str, **props: object) -> Control:
        self.texts.append(Control(content=content, **props))
        return self.texts[-1]

    def add_divider(self, **_: object) -> None:
        pass

    def add_uplot(self, data: tuple, series: tuple, **props: object) -> Control:
        self.charts.append(Control(data=data, series=series, **props))
        return self.charts[-1]

    def add_progress_bar(self, value: float, **props: object) -> Control:
        self.bars.append(Control(value=value, **props))
        return self.bars[-1]

    def __getitem__(self, label: str) -> Control:
        return self.by_label[label]

    @property
    def words(self) -> str:
        """All that is written."""
        return " ".join(text.content for text in self.texts if text.visible)

    def _keep(self, control: Control) -> Control:
        self.by_label[control.label] = control
        return control


class Tab:
    """A container that holds whatever is added."""

    def __enter__(self) -> None:
        pass

    def __exit__(self, *_: object) -> None:
        pass
