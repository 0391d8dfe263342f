package skein.simulator

import scala.util.control.NonFatal
import skein.airsim.wire.Vector3r
import skein.rpc.Encoded
import skein.units.Span
import upack.Msg
import upickle.default.{Writer, writeMsg}

/** The outcome of a call: its answer, or what must happen before it can be answered. */
private[simulator] enum CallOutcome:
  case Answered(result: Msg | Encoded)

  /** The function throws; `text` is the exception's message. */
  case Threw(text: String)

  case Flies(vehicle: Int, order: Move.Order)

  /** A long computation that does not need the simulation any more: `work` may run on another thread. */
  case Draws(work: () => Msg | Encoded)

  /** Physics must advance by this span and then stop; then the call is answered. */
  case Steps(span: Span)

/** A function of the simulator's server, with as many parameters as AirSim's function.
  *
  * @param arguments readers of the parameters; each throws [[BadArgument]] if it refuses
  * @param run computes the outcome from the read arguments
  */
final private[simulator] class ServerMethod(
    val name: String,
    val arguments: List[Argument[?]],
    run: (Simulated, Tuple) => CallOutcome
):
  def arity: Int = arguments.size

  /** Whether these parameters can be read as the function's arguments. */
  def takes(params: IndexedSeq[Msg]): Boolean =
    arity == params.size &&
      (try
        arguments.iterator.zip(params).foreach(_.read(_))
        true
      catch case _: BadArgument => false)

  /** This function with another last argument, which is read and ignored, or with none.
    *
    * @param last the value that the function receives instead of that argument
    */
  def closing(last: Any, read: Option[Argument[?]]): ServerMethod =
    def own(values: Tuple): Tuple = Tuple.fromArray(values.toArray.take(arity - 1).map(x => x: Any) :+ last)
    ServerMethod(name, arguments.init ++ read, (simulation, values) => run(simulation, own(values)))

  /** Never throws: a function that fails answers with its exception, as functions of AirSim do. */
  def apply(simulation: Simulated, params: IndexedSeq[Msg]): CallOutcome =
    try run(simulation, Tuple.fromArray(arguments.iterator.zip(params).map(_.read(_)).toArray[Any]))
    catch
      case bad: BadArgument  => CallOutcome.Threw(bad.getMessage)
      case NonFatal(failure) => CallOutcome.Threw(failure.toString)

private[simulator] object ServerMethod:

  def answer[A: Writer](value: A): CallOutcome = CallOutcome.Answered(writeMsg(value))

  /** Runs an effect whose call has no result. */
  def done(effect: => Unit): CallOutcome =
    effect
    Nil

  val Nil: CallOutcome = CallOutcome.Answered(upack.Null)

  /** Finds the vehicle of this name, or the default one if the name is empty. */
  def vehicle(simulation: Simulated, name: String)(run: (Int, SimulatedVehicle) => CallOutcome): CallOutcome =
    find(simulation, name, "Vehicle API", "this is simulation-only API")(run)

  /** Like `vehicle`, with the error texts of AirSim's simulation-only functions. */
  def simulated(
      simulation: Simulated,
      name: String
  )(run: (Int, SimulatedVehicle) => CallOutcome): CallOutcome =
    find(simulation, name, "Vehicle Sim-API", "this is not a simulation")(run)

  /** Finds a multirotor; for a car the function does not exist. */
  def multirotor(
      simulation: Simulated,
      name: String
  )(run: (Int, SimulatedMultirotor) => CallOutcome): CallOutcome =
    vehicle(simulation, name):
      case (index, multirotor: SimulatedMultirotor) => run(index, multirotor)
      case (_, other)                               =>
        CallOutcome.Threw(s"expected a multirotor, '${other.settings.name}' is a ${other.kind}")

  /** Finds a car; for a multirotor the function does not exist. */
  def car(simulation: Simulated, name: String)(run: (Int, SimulatedCar) => CallOutcome): CallOutcome =
    vehicle(simulation, name):
      case (index, car: SimulatedCar) => run(index, car)
      case (_, other) => CallOutcome.Threw(s"expected a car, '${other.settings.name}' is a ${other.kind}")

  /** Refuses a position that is outside the limits, else runs `run`. */
  def within(place: Vector3r)(run: => CallOutcome): CallOutcome =
    if place.toVector.norm <= VehicleLimits.FarthestM then run
    else CallOutcome.Threw(s"a place within ${(VehicleLimits.FarthestM / 1000).round} km is wanted")

  private def find(simulation: Simulated, name: String, what: String, reason: String)(
      run: (Int, SimulatedVehicle) => CallOutcome
  ): CallOutcome =
    val vehicles = simulation.world.vehicles
    val wanted   = if name.isEmpty then simulation.settings.world.defaultVehicle.name else name
    val index    = vehicles.indexWhere(_.settings.name == wanted)
    if index >= 0 then run(index, vehicles(index))
    else
      CallOutcome.Threw(
        s"$what for '${name}' is not available. This could either " +
          s"because $reason or this vehicle does not exist"
      )
