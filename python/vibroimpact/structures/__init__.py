"""Structures from other programs and from tests, as a ``modes-file`` for scenes.

Each reader returns a :class:`Structure`: frequencies, shapes at named points, and the static compliance at these points
if it is known. ``structure.write("bat.csv")`` writes the table and returns the entry ``structure`` of a scene. All numbers must
be in SI units; a model in millimetres and tonnes is converted by ``length_m`` and ``mass_kg``, its unit of length in metres and
its unit of mass in kilograms.

====================================  ==========================================  =================
reader                                reads                                       needs
====================================  ==========================================  =================
:func:`from_calculix`                 CalculiX ``.dat`` and ``.frd``              numpy
:func:`from_nastran`                  Nastran ``.op2``                            pyNastran
:func:`from_matrices`                 K and M, Matrix Market or scipy.sparse      scipy
:func:`from_universal`                frequency responses, universal file 58      pyuff, scipy
:func:`from_table`                    modes of a test with standard deviations    numpy
====================================  ==========================================  =================
"""

from ._calculix import from_calculix
from ._matrices import from_matrices
from ._nastran import from_nastran
from ._structure import Structure
from ._table import from_table
from ._universal import from_universal

__all__ = ["Structure", "from_calculix", "from_matrices", "from_nastran", "from_table", "from_universal"]
