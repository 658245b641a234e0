// What scripts of the pages use and do not define.
declare const uPlot: any;
interface Element extends HTMLOrSVGElement {}
