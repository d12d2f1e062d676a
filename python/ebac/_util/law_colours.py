"""One colour per law, on figures and pages alike. Apart from the figures: a page needs no Matplotlib."""

#: One colour per law, mostly of Okabe and Ito's palette; a test keeps them apart for colour-blind eyes.
COLOURS = {
    "direct": "#444444",
    "tca": "#d55e00",
    "tca-damped": "#661100",
    "lag-compensator": "#61783f",
    "passivity-control": "#88ccee",
    "iss": "#641f63",
    "virtual-coupling": "#e6ab02",
    "sfa": "#c0a363",
    "force-bounding": "#332288",
    "eba": "#0072b2",
    "eba-account": "#8f97f0",
    "ebac-printed": "#cc79a7",
    "ebac": "#009e73",
}
