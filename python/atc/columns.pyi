from typing import Any

import numpy as np
import numpy.typing as npt

__all__ = ["BLOCK_INPUT", "BLOCK_OUTPUT", "STATUS", "Aspect", "Block", "Pattern"]

BLOCK_INPUT: np.dtype[np.void]
BLOCK_OUTPUT: np.dtype[np.void]
STATUS: tuple[str, ...]

class Aspect:
    def __init__(self, config: dict[str, Any]) -> None: ...
    def run(self, detected: npt.ArrayLike) -> npt.NDArray[np.int8]: ...

class Block:
    def __init__(self, config: dict[str, Any]) -> None: ...
    def run(self, inputs: npt.NDArray[np.void]) -> npt.NDArray[np.void]: ...

class Pattern:
    def __init__(self, brake_mm_s2: int = 800) -> None: ...
    def run(self, distance_m: npt.ArrayLike, gradient_permille: npt.ArrayLike = 0) -> npt.NDArray[np.uint16]: ...
