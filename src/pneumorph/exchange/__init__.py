"""Files for other programs: CalculiX and Abaqus, CAD and printing, tables. (`pneumorph.export` writes an actuator.)"""

from pneumorph.exchange.inp import write_inp
from pneumorph.exchange.inp_mesh import DIALECTS
from pneumorph.exchange.inp_steps import PressureTable
from pneumorph.exchange.programme import up_to
from pneumorph.exchange.solid import write_bodies, write_step, write_stl
from pneumorph.exchange.surface import PARTS, Surface, surface_of
from pneumorph.exchange.tables import pressures_of, write_nodes, write_pressure_volume
from pneumorph.exchange.vtu import write_vtu
from pneumorph.exchange.written import Written

__all__ = [
    "DIALECTS", "PARTS", "PressureTable", "Surface", "Written", "pressures_of", "surface_of", "up_to", "write_bodies",
    "write_inp", "write_nodes", "write_pressure_volume", "write_step", "write_stl", "write_vtu",
]  # fmt: skip
