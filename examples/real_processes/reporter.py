"""Prints which camera the latest frame is from, whenever that changes."""

import sys
import time
from pathlib import Path

frames, last = Path(sys.argv[1]), ""
while True:
    name = frames.read_text(encoding="utf-8").partition(":")[0] if frames.exists() else ""
    if name and name != last:
        print(f"seeing by the {name}", flush=True)
        last = name
    time.sleep(0.05)
