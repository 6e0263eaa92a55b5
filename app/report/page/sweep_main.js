// The page of a sweep, section by section.

showAll(showHead, showFigures, showTrain, showCharts, showBars, showDiagram, showParameters);
