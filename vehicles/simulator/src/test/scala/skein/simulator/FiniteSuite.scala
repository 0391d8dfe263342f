package skein.simulator

import skein.airsim.VehicleSettings
import skein.airsim.wire.*
import upack.*

/** For any numbers that a client sends, with every method, the vehicles' states stay finite. */
class FiniteSuite extends munit.FunSuite:
  private val extremes: Seq[Msg] =
    Seq(Float32(Float.MaxValue), Float32(-1e9f), Float32(3e4f), Float64(1e300), Int32(Int.MinValue))

  /** The value with each of its numbers replaced in turn, and with all of them replaced. */
  private def variants(value: Msg, extreme: Msg): Seq[Msg] = value match
    case Float32(_) | Float64(_) | Int32(_) | Int64(_) => Seq(extreme)
    case Arr(values)                                   =>
      for (inner, at) <- values.toSeq.zipWithIndex; variant <- variants(inner, extreme)
      yield Arr(values.toSeq.updated(at, variant)*)
    case Obj(fields) =>
      val each =
        for (key, inner) <- fields.toSeq; variant <- variants(inner, extreme)
        yield made(fields.toSeq.map((name, old) => if name == key then name -> variant else name -> old))
      each :+ all(value, extreme)
    case _ => Nil

  private def all(value: Msg, extreme: Msg): Msg = value match
    case Float32(_) | Float64(_) | Int32(_) | Int64(_) => extreme
    case Arr(values)                                   => Arr(values.toSeq.map(all(_, extreme))*)
    case Obj(fields)                                   =>
      made(fields.toSeq.map((name, inner) => name -> all(inner, extreme)))
    case other => other

  private def made(fields: Seq[(Msg, Msg)]): Msg = Obj(fields.head, fields.tail*)

  private def isFinite(state: KinematicsState): Boolean =
    Seq(
      state.position,
      state.linear_velocity,
      state.angular_velocity,
      state.linear_acceleration,
      state.angular_acceleration
    ).forall(v => Seq(v.x_val, v.y_val, v.z_val).forall(_.isFinite)) &&
      Seq(state.orientation.w_val, state.orientation.x_val, state.orientation.y_val, state.orientation.z_val)
        .forall(_.isFinite)

  private def benchFor(method: String) =
    if method.contains("Car") then
      val car = Bench.of(VehicleSettings("Evader", vehicleType = "PhysXCar"))
      car.tell("enableApiControl", Bool(true), Str(""))
      car
    else Bench(Seq("Evader")).hovering(-5)

  /** Calls that use the effects of the setters before. */
  private def uses(bench: Bench): Unit =
    if !bench.simulation.world.vehicles.head.settings.isCar then
      bench.velocity(3, -2, -1, 0.4): Unit
      bench.pass(0.2)
      bench.moveTo(10, 10, -10, 5): Unit

  for method <- Simulation.methods do
    test(s"${method.name}: for any numeric arguments, states stay finite"):
      val params = SampleCalls.params(method.name)
      for
        extreme <- extremes
        at      <- params.indices
        variant <- variants(params(at), extreme)
      do
        val bench = benchFor(method.name)
        val token = bench.call(method.name, params.updated(at, variant)*)
        bench.tell("simPause", Bool(false))
        bench.pass(0.2)
        uses(bench)
        bench.pass(0.2)
        val clue = s"${method.name}(${params.updated(at, variant).mkString(", ").take(300)})"
        for vehicle <- bench.simulation.world.vehicles do
          val state = bench.kinematics(vehicle.settings.name)
          assert(isFinite(state), s"$clue: $state")
        if bench.isAnswered(token) then
          for text <- bench.answerOf(token).left do assert(!MethodFuzz.isDefect(text), s"$clue: $text")
