"""Bend a PneuNet: geometry, mesh, model, programme, solve, measure. Ends with the bending angle at 3 kPa."""

import pneumorph as pn

actuator = pn.PneuNet(chambers=4)
model = pn.Model(
    mesh=pn.generate(actuator, coarse=True),
    materials={"body": pn.library.material("ecoflex-pneunet"), "base": pn.library.material("pdms-pneunet")},
    supports=(pn.Clamp("clamp"),),
    cavities=(pn.Cavity("cavity", ("cavity",)),),
)
programme = pn.Programme((pn.Phase("inflate", {"cavity": pn.parse("3 kPa", "pressure")}),))
solution = pn.solve(model, programme, measures=(pn.TipRotation(), pn.ChordAngle()))

history = solution.history
for pressure, angle in zip(history.values("pressure:cavity"), history.values("tip_rotation"), strict=True):
    print(pn.show(pressure, "pressure"), pn.show(angle, "angle"))
