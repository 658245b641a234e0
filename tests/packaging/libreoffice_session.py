"""Use the menu *Monte Carlo* in a running LibreOffice, as a program of the Python that has UNO.

    python libreoffice_session.py PIPE EXTENSION.PY ENTRY BOOK [--installed]

opens BOOK, chooses an entry of the menu, and prints as JSON the messages, the cell that is selected, and the workbooks
that are open then, with the sheet in front of each. With `--installed` the entry is called as a click in the menu calls
it. The entry `install` installs the package BOOK, as LibreOffice's list of extensions does.
"""

import importlib.util
import json
import os
import sys
import time


def connected(pipe):
    """Return the context of LibreOffice, which may still be starting."""
    import uno
    from com.sun.star.connection import NoConnectException

    local = uno.getComponentContext()
    resolver = local.ServiceManager.createInstanceWithContext("com.sun.star.bridge.UnoUrlResolver", local)
    for _ in range(600):
        try:
            return resolver.resolve(f"uno:pipe,name={pipe};urp;StarOffice.ComponentContext")
        except NoConnectException:
            time.sleep(0.1)
    raise SystemExit("LibreOffice did not start")


def install(context, url):
    """Install a package for this user; LibreOffice asks whether it may, and is told that it may."""
    import uno
    import unohelper
    from com.sun.star.deployment import DeploymentException
    from com.sun.star.task import XInteractionHandler
    from com.sun.star.ucb import XCommandEnvironment

    class Willing(unohelper.Base, XCommandEnvironment, XInteractionHandler):
        def getInteractionHandler(self):  # noqa: N802  # UNO's name
            return self

        def getProgressHandler(self):  # noqa: N802
            return None

        def handle(self, request):
            for each in request.getContinuations():
                if each.queryInterface(uno.getTypeByName("com.sun.star.task.XInteractionApprove")):
                    each.select()

    manager = context.getValueByName("/singletons/com.sun.star.deployment.ExtensionManager")
    for left in reversed(range(10)):
        try:
            manager.addExtension(url, (), "user", None, Willing())
            return
        except DeploymentException:  # LibreOffice answers before it has all that it needs for this
            if not left:
                raise
            time.sleep(1.0)


def messages_of(context, extension, entry, answer):
    """Choose an entry of the menu, whose messages are read and answered instead of shown; return them."""
    spec = importlib.util.spec_from_file_location("xlmc_menu", extension)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    shown = []

    class Read(module.Menu):
        def _show(self, message, kind, buttons=1):
            shown.append(message)
            return answer

    os.environ["PYTHONHOME"] = "/nowhere"  # as LibreOffice's own Python sets it on other systems
    Read(context).trigger(entry)
    return shown


def main(pipe, extension, entry, book, *options):
    """Do what the arguments say, and close the workbooks."""
    import uno
    from com.sun.star.beans import PropertyValue

    context = connected(pipe)
    if entry == "install":
        install(context, uno.systemPathToFileUrl(book))
        print("{}")
        return
    desktop = context.ServiceManager.createInstanceWithContext("com.sun.star.frame.Desktop", context)
    document, shown = None, []
    if book != "-":
        hidden = PropertyValue(Name="Hidden", Value=True)
        document = desktop.loadComponentFromURL(uno.systemPathToFileUrl(book), "_blank", 0, (hidden,))
        document.getCurrentController().getFrame().activate()
    if "--modified" in options:
        document.getSheets().getByIndex(0).getCellRangeByName("Z1").setValue(1.0)
    if "--installed" in options:
        dispatcher = context.ServiceManager.createInstanceWithContext("com.sun.star.frame.DispatchHelper", context)
        frame = document.getCurrentController().getFrame()
        dispatcher.executeDispatch(frame, f"service:xlmc.Menu?{entry}", "_self", 0, ())
    else:
        shown = messages_of(context, extension, entry, int("--ok" in options))
    result = {
        "shown": shown,
        "selected": "" if document is None else document.getCurrentSelection().AbsoluteName,
        "modified": document is not None and document.isModified(),
        "opened": {
            each.getTitle(): each.getCurrentController().getActiveSheet().getName()
            for each in desktop.getComponents()
            if hasattr(each, "getSheets")
        },
    }
    print(json.dumps(result))
    for each in list(desktop.getComponents()):
        each.close(True)


if __name__ == "__main__":
    main(*sys.argv[1:])
