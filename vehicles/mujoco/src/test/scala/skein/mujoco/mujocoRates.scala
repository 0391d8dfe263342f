package skein.mujoco

import java.lang.foreign.ValueLayout.JAVA_DOUBLE
import java.lang.foreign.Arena
import java.nio.file.Path
import skein.units.Decimals.fixed
import skein.vehicle.QuadrotorState

/** Steps a second on one thread: vehicles of a model with their flight controllers and a new velocity every
  * 100 ms, compared with MuJoCo's own batch, which makes equally many steps in one call, with rotor-like
  * controls. The two take turns; the best of several rounds counts for each.
  *
  * @param file a model
  * @param vehicles number of vehicles in the batch
  */
@main def mujocoRates(file: String, vehicles: Int, steps: Int, rounds: Int): Unit =
  val model = MujocoModel.read(Path.of(file)).fold(sys.error, identity)
  val ours  = MujocoVehicles(model, vehicles)
  val batch = model.batch(vehicles)
  val hover = model.body.hoveringRow
  val arena = Arena.ofConfined()
  val told  = arena.allocate(JAVA_DOUBLE, vehicles.toLong * steps * model.body.actuators.count)
  for index <- 0L until vehicles.toLong * steps * model.body.actuators.count do
    val wobble  = 1 + 0.05 * math.sin(index * 0.37)
    val control = model.body.controls.at + (index % model.body.actuators.count).toInt
    told.setAtIndex(JAVA_DOUBLE, index, hover(control) * wobble)
  val turnEvery = (0.1 / model.stepS).round.toInt.max(1)

  def rate(work: => Unit): Double =
    val from = System.nanoTime
    work
    vehicles.toDouble * steps / (System.nanoTime - from) * 1e9

  def flown(): Unit =
    for place <- 0 until vehicles do ours.hover(place, -20)
    for step <- 0 until steps do
      if step % turnEvery == 0 then
        for place <- 0 until vehicles do
          val angle = 0.3 * (step / turnEvery) + place
          ours.command(place, (5 * math.cos(angle)).toFloat, (5 * math.sin(angle)).toFloat, -20)
      ours.step()

  def rolledOut(): Unit =
    for place <- 0 until vehicles do batch.setRow(place, hover)
    batch.rollout(steps, told)

  val rates = Vector.fill(rounds)((rate(flown()), rate(rolledOut())))
  val best  = (rates.map(_._1).max, rates.map(_._2).max)
  val first = QuadrotorState()
  ours.read(0, first)
  println(
    s"$file, $vehicles vehicles, $steps steps, best of $rounds: bodies with controllers " +
      s"${best._1.round} /s, mjb_rollout ${best._2.round} /s, " +
      s"${(100 * best._1 / best._2).fixed(1)} %; witness ${first.x}, ${batch(0, model.body.place.at + 2)}"
  )
