package skein.vehicle

import scala.util.Random
import skein.units.Vector3

/** Compares the model without rotors and rates with the complete quadrotor; both receive ten commands per
  * second.
  */
class TiltModelSuite extends munit.FunSuite:
  private final case class Command(north: Double, east: Double, third: Double, holds: Boolean)

  /** The greatest distance between the two, divided by the length of the path. */
  private def deviation(downM: Double, commands: Vector[Command]): Double =
    val model                                = TiltModel.AirSim
    val truth                                = Quadrotor.AirSim.hovering(Vector3(0, 0, downM))
    var (plant, held)                        = (model.initial(downM), Command(0, 0, downM, holds = true))
    var (before, path, farthest)             = (truth.positionNed, 0.0, 0.0)
    def fly(by: Command, forS: Double): Unit =
      var left = forS
      while left > 1e-9 do
        val span = left.min(model.stepS)
        plant = model.step(plant, by.north, by.east, by.third, if by.holds then 1 else 0, span)
        left -= span
    for (command, period) <- commands.zipWithIndex do
      import command.{east, north, third}
      val setpoint =
        if command.holds then Setpoint.velocityZ(north, east, third)
        else Setpoint.velocity(north, east, third)
      val steps = if period % 3 == 2 then 34 else 33
      for _ <- 1 to steps do Quadrotor.AirSim.step(truth, setpoint, Environment.Calm)
      fly(held, model.deadTimeS)
      fly(command, steps * Quadrotor.AirSim.stepS - model.deadTimeS)
      held = command
      path += (truth.positionNed - before).norm
      before = truth.positionNed
      farthest = farthest.max((before - Vector3(plant.northM, plant.eastM, plant.downM)).norm)
    farthest / path

  private def lasting(seconds: Int, north: Double, third: Double, holds: Boolean) =
    Vector.fill(seconds * 10)(Command(north, 0, third, holds))

  for
    (name, downM, commands, share) <- Seq(
      ("climbs", -20.0, lasting(10, 0, -2, holds = false), 0.005),
      ("sinks", -20.0, lasting(8, 0, 2, holds = false), 0.005),
      ("climbs on its way", -20.0, lasting(20, 5, -2, holds = false), 0.005),
      ("sinks on its way", -20.0, lasting(18, 8, 1, holds = false), 0.005),
      ("changes its altitude by six metres", -20.0, lasting(10, 0, -26, holds = true), 0.015),
      ("flies level at 20 m", -20.0, lasting(30, 10, -20, holds = true), 0.002),
      ("flies level at 5 m", -5.0, lasting(30, 5, -5, holds = true), 0.002)
    )
  do
    test(s"the model agrees with the quadrotor for a vehicle that $name"):
      val off = deviation(downM, commands)
      assert(off < share, s"off by ${100 * off} % of the path")

  for seed <- 1 to 6 do
    test(s"the model agrees with the quadrotor in turns with changes of altitude and climb rate, seed $seed"):
      val random = Random(seed)
      var angle  = 0.0
      var goal   = Command(0, 0, 0, holds = false)
      val flown  = Vector.tabulate(600): period =>
        if period % 20 == 0 then
          val holds = random.nextBoolean()
          val third = if holds then -15 - 10 * random.nextDouble() else 4 * random.nextDouble() - 2
          goal = Command(8 * random.nextDouble(), 0, third, holds)
        angle += 0.05 * (seed - 3)
        goal.copy(north = goal.north * math.cos(angle), east = goal.north * math.sin(angle))
      val off = deviation(-20, flown)
      assert(off < 0.02, s"off by ${100 * off} % of the path")
