from ebac.live.gastroscopy import serve_gastroscopy as serve_gastroscopy
from ebac.live.live_page import page as page
from ebac.live.notebook_widget import widget as widget
from ebac.live.serving import serve as serve
from ebac.live.session import Session as Session
from ebac.live.wasm_module import module as module
