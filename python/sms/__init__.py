"""Pneumatic motion platform: its equations, and what measured data says about them.

Names are listed in __init__.pyi, and imported where they are first used: `sms --help` waits neither for numpy nor for
the compiled core.
"""

import lazy_loader

from sms import _dispatch  # noqa: F401  # decides which copy of the core sms._core is

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
