"""One workbook that is open: its session, its windows, the thread that computes, the file that is watched."""

from __future__ import annotations

import asyncio
import gc
import os
import time
from collections.abc import Callable, Coroutine, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final, TypeVar

from watchfiles import awatch

from xlmc.errors import WorkbookError, XlmcError
from xlmc.montecarlo.definitions.number_styles import in_style
from xlmc.montecarlo.model.loading import load
from xlmc.outputs.live.adjustments import Adjustments
from xlmc.outputs.live.adjustments_in_words import in_words
from xlmc.outputs.live.hand_over import KINDS, edited_state, page_of, save_result, write_changes
from xlmc.outputs.live.jobs import Job, Outcome, SupersededError, View
from xlmc.outputs.live.library import Library
from xlmc.outputs.live.protocol import Message, PageMessage, written
from xlmc.outputs.live.session import MEMORY, Session
from xlmc.outputs.live.study_run import OF_THE_FILE, StudyRun
from xlmc.outputs.live.what_changed import what_changed

if TYPE_CHECKING:
    from xlmc.montecarlo.model.model import CompiledModel

__all__ = ["OpenBook", "Window"]

_PAUSE: Final = 0.15
"""Seconds that a held handle must be still before the longer runs begin."""

_KEPT_AFTER: Final = 0.3
"""Seconds after a number was set until the state is written to a file: the answer comes first."""

_PROGRESS_EVERY: Final = 0.1
"""Seconds between two messages on how far a run is."""

_SETTLING: Final = (0.0, 0.1, 0.3, 0.6, 1.0)
"""Seconds before each try to read a workbook that was just saved: a half-written one is whole a moment later."""

_CHANGING: Final = frozenset(
    {"set", "numbers", "reset", "run", "keep", "show", "drop", "restore", "variants", "undo", "redo"}
)
"""Kinds after which what outlives the window is other."""

_TELLS: Final[Mapping[str, tuple[str, ...]]] = {
    "moved": ("of", "name", "key"),
    "part": ("tab",),
    "trouble": ("about",),
    "news": ("text",),
}
"""Kind -> what else tells what a message is of. Of one thing a window that lags behind needs the newest message alone:
so what waits for a window that sleeps does not grow with the time.
"""

_MOST_NEWS: Final = 20


T = TypeVar("T")


class Window:
    """What one window shows, and what is still to be sent to it."""

    def __init__(self) -> None:
        self.view: PageMessage | None = None
        self.refused = self.holds = False
        self._waiting: dict[tuple[str, ...], str] = {}
        self._more = asyncio.Event()

    def put(self, message: Message, text: str | None = None) -> None:
        """Add a message, which may be written already; an older one of the same that was not sent yet goes."""
        kind = message["kind"]
        of = (kind, *(str(message[name]) for name in _TELLS.get(kind, ())))
        self._waiting.pop(of, None)
        self._waiting[of] = written(message) if text is None else text
        news = [each for each in self._waiting if each[0] == "news"]
        for old in news[:-_MOST_NEWS]:
            del self._waiting[old]
        self._more.set()

    async def next(self) -> str:
        """Return the next message, when there is one."""
        while not self._waiting:
            self._more.clear()
            await self._more.wait()
        return self._waiting.pop(next(iter(self._waiting)))


class OpenBook:
    """See the module.

    Args:
        path: of the workbook.
        library: of the workbooks that may be opened beside it.
        offer: takes a page of results, and gives the ticket for it.
        memory: see `Session`.
    """

    def __init__(self, path: Path, library: Library, offer: Callable[[str], str], memory: int = MEMORY) -> None:
        self.path, self._memory = path, memory
        self.session: Session | None = None
        self._library, self._keeper, self._windows = library, library.keeper, set[Window]()
        self._study: StudyRun | None = None
        self._offer = offer
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="xlmc-window")
        self._aside = ThreadPoolExecutor(2, thread_name_prefix="xlmc-files")
        self._wake = asyncio.Event()
        self._trouble: dict[str, str] = {}
        self._tasks: list[asyncio.Task[None]] = []
        self._stamp: tuple[int, ...] | None = None
        self._keeping: asyncio.TimerHandle | None = None

    def start(self) -> None:
        """Begin to read, to compute and to watch; in a running event loop."""
        for about, what in (("work", self._work()), ("watching", self._watch())):
            task = asyncio.create_task(what)
            task.add_done_callback(partial(self._ended, about))
            self._tasks.append(task)

    def _ended(self, about: str, task: asyncio.Task[None]) -> None:
        """Tell it where what should go on has ended by a fault."""
        fault = None if task.cancelled() else task.exception()
        if fault is not None:
            self._say(about, f"xlmc has failed, and must be started again: {type(fault).__name__}: {fault}")

    async def close(self) -> None:
        """End all of it."""
        for task in self._tasks:
            task.cancel()
        if self._keeping is not None:
            self._keep()
        if self.session is not None:
            self.session.end()  # a run that is going on is not wanted any more
        await asyncio.gather(*self._tasks, return_exceptions=True)
        for pool in (self._pool, self._aside):
            pool.shutdown(wait=False, cancel_futures=True)

    def join(self) -> Window:
        """Take a window that was opened, or came back."""
        window = Window()
        self._windows.add(window)
        for message in self.session.greeting() if self.session is not None else ():
            window.put(message)
        for about, text in self._trouble.items():
            window.put({"kind": "trouble", "about": about, "text": text})
        others = [each for each in self._library.books() if self._library.path(each["key"]) != self.path]
        window.put({"kind": "others", "books": others})
        if self._study is not None:
            window.put(self._study.last)
        return window

    def leave(self, window: Window) -> None:
        """Take it that a window was closed; a handle that it held is let go."""
        self._windows.discard(window)
        if window.holds and self.session is not None:
            self._send([self.session.let_go()])
            self._wake.set()
        if self._keeping is not None or window.holds:
            self._keep()
        self._look()

    def _look(self) -> None:
        """Tell the session what can be seen in all windows; with none, it goes on as before."""
        views = [window.view for window in self._windows if window.view is not None]
        if views and self.session is not None:
            self.session.look(View.of(views, [each.name for each in self.session.own.forecasts]))
            self._wake.set()

    def hear(self, window: Window, sent: PageMessage) -> None:
        """Take what a window says."""
        if sent.kind == "view":
            window.view = sent
            self._look()
        if self.session is None or sent.kind in ("view", "hello"):
            return
        if sent.kind == "study":
            self._ask(window, sent["what"], sent["other"])
            return
        if sent.kind == "cancel":
            if self._study is not None:
                self._later(self._study.cancel())
            return
        if sent.kind == "save":
            self._later(self._save(sent["what"]))
            return
        if sent.kind == "print":
            self._later(self._print(window))
            return
        if sent.kind in ("set", "numbers"):
            window.holds = sent.kind == "set" and sent["held"]
        try:
            replies = self.session.receive(sent)
        except XlmcError as error:
            self._refuse(window, str(error))
            return
        if sent.kind in _CHANGING:
            self._is_over(window)
        for message in replies.own:
            window.put(message)
        self._send(replies.all)
        if sent.kind in ("set", "numbers"):
            self._keep_soon()
        elif sent.kind in _CHANGING:
            self._keep()
        self._wake.set()

    def _refuse(self, window: Window, why: str) -> None:
        """Say why what a window asked for is not done; with an empty text, that this does not matter any more."""
        if why or window.refused:
            window.put({"kind": "trouble", "about": "request", "text": why})
        window.refused = bool(why)

    def _is_over(self, window: Window) -> None:
        """Take back what was said of a state, as there is another one."""
        self._refuse(window, "")
        for about in ("save", "study"):
            self._say(about, "")

    def _later(self, what: Coroutine[object, object, None]) -> None:
        task = asyncio.create_task(what)
        self._tasks.append(task)
        task.add_done_callback(lambda done: self._tasks.remove(done) if done in self._tasks else None)

    def _send(self, messages: Iterable[Message]) -> None:
        for message in messages:
            text = written(message)
            for window in self._windows:
                window.put(message, text)

    def _send_study(self, message: Message) -> None:
        self._send([message])

    def _say(self, about: str, text: str) -> None:
        """Tell of a trouble; an empty text says that it is over."""
        if text:
            self._trouble[about] = text
        elif self._trouble.pop(about, None) is None:
            return
        self._send([{"kind": "trouble", "about": about, "text": text}])

    def _keep_soon(self) -> None:
        """Keep the state once no number has been set for a moment."""
        if self._keeping is not None:
            self._keeping.cancel()
        self._keeping = asyncio.get_running_loop().call_later(_KEPT_AFTER, self._keep)

    def _keep(self) -> None:
        """Keep the scenarios and the state for when the workbook is opened again."""
        if self._keeping is not None:
            self._keeping.cancel()
            self._keeping = None
        if self.session is None:
            return
        try:
            stored = self._keeper.keep(self.path, self.session.stored, self.session.unkept)
        except WorkbookError as error:
            self._say("keeping", str(error))
            return
        self._say("keeping", "")
        if stored != self.session.stored:  # another window on this workbook kept some, too
            self.session.adopt(stored)
            self._send(self.session.greeting()[1:2])

    async def _beside(self, what: Callable[[], T]) -> T:
        """Read or write a file while runs go on."""
        return await asyncio.get_running_loop().run_in_executor(self._aside, what)

    async def _read(self) -> CompiledModel | None:
        """Read the workbook's model; returns None if it cannot be read or understood, and tells why."""
        trouble = ""
        for seconds in _SETTLING:
            await asyncio.sleep(seconds)
            self._stamp = _stamp(self.path)
            try:
                model = await self._beside(lambda: load(self.path, functions=self._library.functions))
            except (XlmcError, OSError) as error:
                trouble = str(error)
                if not isinstance(error, WorkbookError | OSError):
                    break  # it was read, and is not what it must be
            else:
                if _stamp(self.path) != self._stamp:
                    return None  # it was saved once more meanwhile: who asked reads it again
                self._say("book", "")
                await self._beside(_leave_to_itself)
                return model
        self._say("book", trouble)
        return None

    async def _work(self) -> None:
        while (model := await self._read()) is None:
            await self._changed()
        stored, unkept = self._stored_before()
        self.session = Session(model, stored, unkept, self._memory)
        self._send(self.session.greeting())
        while True:
            job = self.session.job()
            if job is None or (job.dragged and job.stage not in ("quick", "moving", "sketch")):
                try:
                    await asyncio.wait_for(self._wake.wait(), None if job is None else _PAUSE)
                    self._wake.clear()
                    continue
                except TimeoutError:
                    pass
            if job is not None:
                await self._do(self.session, job)

    def _stored_before(self) -> tuple[dict[str, Adjustments], Adjustments]:
        try:
            return self._keeper.scenarios(self.path)
        except WorkbookError as error:
            self._say("keeping", str(error))
            return {}, Adjustments()

    async def _do(self, session: Session, job: Job) -> None:
        loop, last_sent = asyncio.get_running_loop(), [time.monotonic()]

        def tell(share: float) -> None:
            if time.monotonic() - last_sent[0] > _PROGRESS_EVERY:
                last_sent[0] = time.monotonic()
                sent = {"kind": "running", "version": job.version, "stage": job.stage, "share": share}
                loop.call_soon_threadsafe(self._send, [sent])

        def run() -> Outcome:
            with in_style(session.own.definitions.settings.number_style):
                return job.run(lambda: session.wanted(job), tell, time.monotonic)

        try:
            outcome = await loop.run_in_executor(self._pool, run)
        except SupersededError:
            self._send(session.superseded(job))
            return
        except Exception as error:  # a fault of xlmc's own must not end the window
            outcome = Outcome(problem=f"xlmc has failed: {type(error).__name__}: {error}")
        dropped = [session.rest]
        self._send(session.finish(job, outcome))
        loop.run_in_executor(self._aside, dropped.clear)  # to give a run's memory and files back takes its time

    async def _save(self, what: str) -> None:
        """Write what is shown; say where, or why not."""
        if self.session is None:
            return
        try:
            state = self.session.at_rest()
            if what in KINDS:
                text = f"Written: {await self._beside(lambda: save_result(state, self.path, what))}"
            else:
                text = await self._beside(lambda: write_changes(state, self.path, into=what == "into"))
        except (XlmcError, OSError) as error:
            self._say("save", str(error))
        else:
            self._say("save", "")
            self._send([{"kind": "news", "text": text, "link": ""}])

    async def _print(self, window: Window) -> None:
        """Make the page of what is shown, and tell the window that asked where it is; or why there is none."""
        if self.session is None:
            return
        try:
            state = self.session.at_rest()
            text = await self._beside(lambda: page_of(state))
        except (XlmcError, OSError) as error:
            self._say("save", str(error))
        else:
            self._say("save", "")
            window.put({"kind": "page", "path": f"/print/{self._offer(text)}"})

    def _ask(self, window: Window, what: str, other: str) -> None:
        """Start a study, unless one is going on."""
        trouble = "A study is going on: cancel it, or wait." if self._study and self._study.is_running else ""
        others: list[Path] = []
        if what == "compare":
            second = self._library.path(other)
            others += [] if second is None else [second]
            trouble = trouble or ("" if second else "Choose the workbook to compare this one with.")
        if trouble:
            self._refuse(window, trouble)
            return
        self._say("study", "")
        session = self.session
        if what in OF_THE_FILE or session is None or not session.adjustments:
            self._begin(StudyRun(what, [self.path, *others], self._send_study))
        else:
            self._later(self._ask_of_state(session, what, others))

    def _begin(self, study: StudyRun) -> None:
        self._study = study
        self._later(study.run())

    async def _ask_of_state(self, session: Session, what: str, others: Sequence[Path]) -> None:
        """Start a study of the state that is shown, which is typed into a copy of the workbook for it."""
        own, adjustments, name = session.own, session.adjustments, session.shown
        try:
            edited = await self._beside(lambda: edited_state(own, adjustments, name))
        except (XlmcError, OSError) as error:
            self._say("study", str(error))
            return
        of = in_words(own.definitions, adjustments)
        if self._study is None or not self._study.is_running:
            self._begin(StudyRun(what, [self.path, *others], self._send_study, of, edited.data))

    # The file

    async def _watch(self) -> None:
        """Read the workbook again whenever it was saved, in place or by a rename."""
        folder, name = self.path.parent, self.path.name
        async for changes in awatch(folder, recursive=False, debounce=100, step=20, rust_timeout=1000):
            if any(os.path.basename(each) == name for _, each in changes) and _stamp(self.path) != self._stamp:
                await self._again()

    async def _changed(self) -> None:
        """Wait until the file is another."""
        while _stamp(self.path) == self._stamp:
            await asyncio.sleep(0.2)

    async def _again(self) -> None:
        session = self.session
        if session is None:
            return  # `_work` is still reading it
        before = session.own
        model = await self._read()
        if model is not None:
            self._send(session.replace_book(model, what_changed(before, model)))
            self._say("save", "")
            self._wake.set()


def _leave_to_itself() -> None:
    """Let the collector of cycles pass over what is there now: a workbook's model would hold a move up each time."""
    gc.unfreeze()
    gc.collect()
    gc.freeze()


def _stamp(path: Path) -> tuple[int, ...] | None:
    """Return what differs once a file was saved."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_ino, status.st_size
