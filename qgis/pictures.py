# SPDX-FileCopyrightText: the thalweg authors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes the pictures of docs/qgis.md in the window of QGIS: `scripts/gallery qgis` starts QGIS with it.

The environment's SAMPLES is the folder with samples, PICTURES the one for pictures; the current one is empty."""
import os
import pathlib
import traceback

import processing
from qgis.core import QgsApplication, QgsProject, QgsRectangle, QgsSettings
from qgis.PyQt.QtCore import QEventLoop, QPoint, QRect, Qt, QTimer
from qgis.PyQt.QtGui import QColor, QPainter
from qgis.PyQt.QtWidgets import QDockWidget, QTableView, QTreeView
from qgis.utils import iface, loadPlugin, startPlugin

SAMPLES, PICTURES, HERE = pathlib.Path(os.environ["SAMPLES"]), pathlib.Path(os.environ["PICTURES"]), pathlib.Path.cwd()
WINDOW = QRect(0, 0, 1300, 800)
TITLE_BAR = 28  # [pixels] of a dialog: without a window manager it has none


def wait(seconds):
    """Let QGIS draw."""
    loop = QEventLoop()
    QTimer.singleShot(int(seconds * 1000), loop.quit)
    loop.exec_()
    while iface.mapCanvas().isDrawing():
        QgsApplication.processEvents()


def dock(name):
    """A panel of the window."""
    return iface.mainWindow().findChild(QDockWidget, name)


def parent_dock(widget):
    """The panel that a widget is in."""
    while not isinstance(widget, QDockWidget):
        widget = widget.parentWidget()
    return widget


def fresh():
    """An empty project, with the layers at the left alone."""
    iface.newProject()
    for panel in iface.mainWindow().findChildren(QDockWidget):
        panel.setVisible(panel.objectName() == "Layers")
    iface.mainWindow().resizeDocks([dock("Layers")], [290], Qt.Horizontal)
    iface.messageBar().clearWidgets()


def picture(name, dialog=None):
    """The window and, over it, a dialog."""
    wait(2)
    iface.messageBar().clearWidgets()
    wait(1)
    window = iface.mainWindow().grab()
    if dialog is not None:
        painter = QPainter(window)
        place = QRect(QPoint(215, 135), dialog.size())
        bar = QRect(place.left(), place.top() - TITLE_BAR, place.width(), TITLE_BAR)
        painter.fillRect(bar, QColor("#d6d6d6"))
        painter.drawText(bar, Qt.AlignCenter, dialog.windowTitle())
        painter.drawPixmap(place.topLeft(), dialog.grab())
        painter.setPen(QColor("#808080"))
        painter.drawRect(place.adjusted(-1, -TITLE_BAR - 1, 0, 0))
        painter.end()
    window.save(str(PICTURES / f"qgis_{name}.png"))


def toolbox_open():
    """Show the toolbox with thalweg's algorithms."""
    toolbox = dock("ProcessingToolbox")
    toolbox.show()
    tree = toolbox.findChild(QTreeView)
    tree.collapseAll()
    for row in range(tree.model().rowCount()):
        index = tree.model().index(row, 0)
        if index.data().startswith("thalweg"):
            tree.expandRecursively(index)
    iface.mainWindow().resizeDocks([toolbox], [270], Qt.Horizontal)
    wait(1)
    tree.scrollToBottom()


def begin():
    """An empty project with the rivers, as QGIS has them when their file is dropped into its window."""
    fresh()
    rivers = iface.addVectorLayer(str(SAMPLES / "coastal_nhdplus.gpkg"), "coastal_nhdplus", "ogr")
    rivers.renderer().symbol().setColor(QColor("#7a7a7a"))  # QGIS takes a random one
    iface.layerTreeView().refreshLayerSymbology(rivers.id())
    QgsProject.instance().setCrs(rivers.crs())
    iface.mapCanvas().setExtent(rivers.extent())
    return rivers


def ten_minutes():
    """The steps of docs/qgis.md, with pictures of some."""
    rivers = begin()
    toolbox_open()
    dialog = processing.createAlgorithmDialog("thalweg:make", {"RIVERS": rivers, "OUTPUT": "coast"})
    dialog.resize(780, 625)
    dialog.show()
    dialog.setFocus()
    picture("make", dialog)
    dialog.close()

    rivers = begin()
    processing.runAndLoadResults("thalweg:check", {"NETWORK": rivers, "FIX": str(HERE / "repaired.gpkg"),
                                                   "FINDINGS": str(HERE / "findings.gpkg")})
    layers = {layer.name(): layer for layer in QgsProject.instance().mapLayers().values()}
    iface.setActiveLayer(layers["Findings"])
    iface.showAttributeTable(layers["Findings"])
    wait(1)
    table = next(view for view in iface.mainWindow().findChildren(QTableView)
                 if view.isVisible() and view.model().columnCount() > 3)
    for column, pixels in enumerate((0, 140, 80, 0, 740)):  # without fid and amount
        table.setColumnWidth(column, pixels)
    iface.mainWindow().resizeDocks([parent_dock(table)], [290], Qt.Vertical)
    layers["Findings"].selectByIds([4, 5, 6])
    iface.mapCanvas().zoomToSelected(layers["Findings"])
    layers["Findings"].removeSelection()
    iface.mapCanvas().zoomByFactor(1.6)
    picture("findings")
    parent_dock(table).close()

    rivers = str(SAMPLES / "coastal_nhdplus.gpkg")
    made = processing.run("thalweg:make", {"RIVERS": rivers, "OUTPUT": str(HERE / "coast"), "LOAD": []})
    fresh()
    iface.addProject(made["PROJECT"])
    picture("project")

    made = processing.run("thalweg:make", {"RIVERS": rivers, "SKELETON_TIN": "true", "OUTPUT": str(HERE / "tin"), "LOAD": []})
    fresh()
    iface.addProject(made["PROJECT"])
    root = QgsProject.instance().layerTreeRoot()
    for node in root.findLayers():
        if node.name() in ("Contours", "Heights", "Hillshade"):
            node.setExpanded(False)
            node.setItemVisibilityChecked(False)
        elif node.name() == "TIN":
            node.setExpanded(True)
            node.setItemVisibilityChecked(True)
    iface.mapCanvas().setExtent(QgsRectangle(384000, 4452000, 396000, 4464500))
    picture("tin")


def main():
    try:
        QgsSettings().setValue("qgis/dockAttributeTable", True)
        iface.mainWindow().setGeometry(WINDOW)
        assert loadPlugin("thalweg_processing") and startPlugin("thalweg_processing")
        ten_minutes()
        code = 0
    except BaseException:
        traceback.print_exc()
        code = 1
    os._exit(code)  # QGIS asks what to do with the project


QTimer.singleShot(2000, main)
