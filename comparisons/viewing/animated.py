"""The door to Pillow, which matplotlib brings: pictures one after the other, as GIF or animated PNG.

The same pictures give the same bytes.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Literal

SECONDS = 6.0
"""How long a run through all pictures takes, the last one's rest left out."""
SHORTEST, LONGEST, REST = 40, 500, 1500  # milliseconds that a picture stays; the last one


def animation(pictures: Sequence[bytes], kind: Literal["gif", "apng"]) -> bytes:
    """PNG ``pictures`` of one size as an animation that begins anew for ever."""
    from PIL import Image

    each = int(min(LONGEST, max(SHORTEST, 10 * round(100.0 * SECONDS / len(pictures)))))
    stays = [each] * (len(pictures) - 1) + [max(each, REST)]
    frames = [Image.open(io.BytesIO(content)).convert("RGB") for content in pictures]
    stream = io.BytesIO()
    if kind == "gif":
        # one palette for all, of the last picture, which has all colours that there are: or else they flicker
        palette = frames[-1].quantize(colors=255)
        frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
        frames[0].save(stream, "GIF", save_all=True, append_images=frames[1:], duration=stays, loop=0, disposal=1)
    else:
        frames[0].save(stream, "PNG", save_all=True, append_images=frames[1:], duration=stays, loop=0)
    return stream.getvalue()
