"""A camera: writes the number of each frame into a file, as often as it is told on standard input."""

import argparse
import json
import select
import sys
from pathlib import Path

arguments = argparse.ArgumentParser()
arguments.add_argument("frames", type=Path)
arguments.add_argument("--name", default="camera")
options = arguments.parse_args()

rate, number = 5.0, 0
listening = [sys.stdin]
print("the stream is open", flush=True)
while True:
    # Standard input may be closed: then there is nothing to hear, and only time passes.
    if select.select(listening, [], [], 1 / rate)[0]:
        line = sys.stdin.readline()
        if line:
            rate = float(json.loads(line).get("rate", rate))
        else:
            listening = []
    number += 1
    options.frames.write_text(f"{options.name}: frame {number} at {rate:g} Hz\n", encoding="utf-8")
