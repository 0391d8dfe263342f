package skein.forward

import skein.policy.Action
import skein.units.Metres

class DeadTimeSuite extends munit.FunSuite:
  test("each of many commands takes effect a dead time after its arrival, however many are pending"):
    val vehicle = VelocityResponses.lag(gain = 1, lagS = 0, deadTimeS = 3).create()
    vehicle.start(0, 0, 0)
    for step <- 0 until 1000 do
      val nowS = step / 128.0
      vehicle.advance(nowS)
      vehicle.act(Action.VelocityAt(step, -step, Metres(0)))
      vehicle.advance(nowS + 1 / 256.0)
      if step >= 384 then assertEquals((vehicle.vx, vehicle.vy), (step - 384.0, 384.0 - step), s"at $nowS s")
