package skein.airsim.simulator

import scala.compiletime.constValue
import scala.util.{Failure, Success, Try}
import skein.airsim.wire.Text
import skein.units.Span
import upack.{Arr, Float32, Float64, Msg, Obj}
import upickle.default.{Reader, Writer, readBinary, writeMsg}

/** What a call leads to. */
private[simulator] enum Outcome:
  case Answered(result: Msg)

  /** The function throws; `text` is the exception's. */
  case Threw(text: String)

  /** A move: it answers when it ends. */
  case Flies(vehicle: Int, order: Move.Order)

  /** Physics is to run for this long and then stand; that answers. */
  case Steps(span: Span)

/** A function that the simulator's server has, with as many parameters as AirSim's.
  *
  * @param read
  *   what to do with these parameters; throws if they are of other types
  */
final private[simulator] class Method(
    val name: String,
    val arity: Int,
    read: IndexedSeq[Msg] => Simulation => Outcome
):
  def apply(simulation: Simulation, params: IndexedSeq[Msg]): Outcome =
    if !params.forall(Method.isFinite) then Outcome.Threw("parameters must be finite numbers")
    else
      Try(read(params)) match
        case Success(run) => run(simulation)
        case Failure(_)   => Outcome.Threw("std::bad_cast")

private[simulator] object Method:

  def none(name: String)(run: Simulation => Outcome): Method = Method(name, 0, _ => run)

  def one[A: Reader](name: String)(run: (Simulation, A) => Outcome): Method =
    Method(
      name,
      1,
      params =>
        val value = readBinary[A](params.head, trace = false)
        run(_, value)
    )

  /** A function of several parameters, read as the tuple that `run` takes. */
  inline def many[T <: Tuple: Reader](name: String)(run: (Simulation, T) => Outcome): Method =
    Method(
      name,
      constValue[Tuple.Size[T]],
      params =>
        val values = readBinary[T](Arr(params*), trace = false)
        run(_, values)
    )

  def answer[A: Writer](value: A): Outcome = Outcome.Answered(writeMsg(value))

  val Nil: Outcome = Outcome.Answered(upack.Null)

  /** The vehicle of this name, or the first if it is empty. */
  def vehicle(simulation: Simulation, name: Text)(run: (Int, SimulatedVehicle) => Outcome): Outcome =
    find(simulation, name, "Vehicle API", "this is simulation-only API")(run)

  /** The same, with the words of AirSim's functions that exist in simulation only. */
  def simulated(simulation: Simulation, name: Text)(run: (Int, SimulatedVehicle) => Outcome): Outcome =
    find(simulation, name, "Vehicle Sim-API", "this is not a simulation")(run)

  private def find(simulation: Simulation, name: Text, what: String, reason: String)(
      run: (Int, SimulatedVehicle) => Outcome
  ): Outcome =
    val vehicles = simulation.world.vehicles
    val index    = if name.value.isEmpty then 0 else vehicles.indexWhere(_.settings.name == name.value)
    if index >= 0 then run(index, vehicles(index))
    else
      Outcome.Threw(
        s"$what for '${name.value}' is not available. This could either because $reason or this vehicle does not exist"
      )

  /** Numbers that are none would poison physics for good. */
  private def isFinite(value: Msg): Boolean = value match
    case Float32(number) => number.isFinite
    case Float64(number) => number.isFinite
    case Arr(values)     => values.forall(isFinite)
    case Obj(entries)    => entries.values.forall(isFinite)
    case _               => true
