package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Predicts motion in space with a plant; the orientation stays as in the last reading. A setpoint that is
  * not a velocity, with or without an altitude, means "stand still". Before the first command the vehicle
  * holds the altitude of its first reading.
  */
final case class SpatialModel[S](plant: ObservedSpatialPlant[S]) extends VehicleModel[SpatialModel.Flying[S]]:
  import SpatialModel.*

  private val deadTime = Span.ofSeconds(plant.deadTimeS)

  def start(seen: Kinematics): Flying[S] =
    val down = seen.positionNed.z
    Flying(
      seen,
      plant.corrected(plant.initial(down), readingOf(seen)),
      PendingCommands.resting(Command(0, 0, down, 1))
    )

  def advanced(flying: Flying[S], setpoint: Setpoint, span: Span): Flying[S] =
    val (due, commands) = flying.commands.after(commandOf(setpoint), deadTime, span)
    val flight          = SpatialFlight(plant)
    def acting(atS: Double, command: Command)(set: (Double, Double, Double, Double, Double) => Unit) =
      set(atS, command.northMps, command.eastMps, command.third, command.holds)
    acting(0, flying.commands.acting)(flight.start(_, flying.state, _, _, _, _))
    for next <- due do
      flight.advance(next.in.toSeconds)
      acting(next.in.toSeconds, next.command)(flight.act)
    flight.advance(span.toSeconds)
    val reading = flight.reading
    Flying(
      flying.now.copy(
        positionNed = Vector3(reading.northM, reading.eastM, reading.downM),
        velocityNed = Vector3(reading.northMps, reading.eastMps, reading.downMps)
      ),
      flight.state,
      commands
    )

  def corrected(flying: Flying[S], seen: Kinematics, sinceSeen: Span): Flying[S] =
    flying.copy(now = seen, state = plant.corrected(flying.state, readingOf(seen)))

  def kinematics(flying: Flying[S]): Kinematics = flying.now

  override def numbers: Flying[S] => Vector[Double] = flying => PlantState.numbers(flying.state)

object SpatialModel:

  /** The state of a prediction. */
  final case class Flying[S] private[vehicle] (
      now: Kinematics,
      state: S,
      private[vehicle] val commands: PendingCommands[Command]
  )

  /** A command as in [[SpatialPlant.step]]. */
  private[vehicle] final case class Command(northMps: Double, eastMps: Double, third: Double, holds: Double)

  private def readingOf(seen: Kinematics) = SpaceReading(
    seen.positionNed.x,
    seen.positionNed.y,
    seen.velocityNed.x,
    seen.velocityNed.y,
    seen.positionNed.z,
    seen.velocityNed.z
  )

  private def commandOf(setpoint: Setpoint): Command = (setpoint.horizontal, setpoint.vertical) match
    case (HorizontalMode.Velocity, VerticalMode.Velocity) =>
      Command(setpoint.first, setpoint.second, setpoint.third, 0)
    case (HorizontalMode.Velocity, VerticalMode.Position) =>
      Command(setpoint.first, setpoint.second, setpoint.third, 1)
    // As vehicles are assumed to do before their first command.
    case (HorizontalMode.Position, VerticalMode.Position) => Command(0, 0, setpoint.third, 1)
    case _                                                => Command(0, 0, 0, 0)
