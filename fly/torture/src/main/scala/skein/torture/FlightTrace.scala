package skein.torture

import skein.flight.CameraSensor
import skein.loop.FlightOutcome
import skein.record.{Record, RecordError, Recording}
import skein.rpc.{RpcSettings, RpcStats}
import skein.units.*

/** What was seen of one flight from outside: enough to judge it.
  *
  * @param ports by vehicle
  * @param arrivals at the simulator, in order, of all vehicles
  * @param mostUnanswered moves of one vehicle that the simulator had not answered at one time
  * @param mostPending calls that the client had not ended at one time
  * @param lastHovers when, if ever, the simulator was last told that a vehicle is to hover
  * @param stats after the client was closed
  * @param offered to the recorder, in order, while it could keep it
  * @param file what is read back from the recording's file, or why that is not possible, where a file was
  *   written
  * @param runs of the simulator
  * @param drifts how far each vehicle got within [[FlightTrace.Watched]], some time after the end
  * @param steps calls that let the simulator's time run in steps
  * @param callsBeside how often vehicles were asked for a sign of life
  * @param leftPaused whether the simulator stood still some time after the end
  * @param images of each eye, after it has ended
  */
final case class FlightTrace(
    faultPlan: FaultPlan,
    window: Int,
    minCommandInterval: Span,
    period: Span,
    patience: Span,
    startedAt: Instant,
    endedAt: Instant,
    outcome: FlightOutcome,
    vehicles: Vector[String],
    ports: Vector[WatchedVehicle],
    arrivals: Vector[ReceivedMove],
    lastHovers: Map[String, Instant],
    mostUnanswered: Int,
    mostPending: Long,
    settings: RpcSettings,
    stats: RpcStats,
    recording: Recording,
    offered: Vector[Record],
    file: Option[Either[RecordError, Recording]],
    runs: Vector[Run],
    drifts: Vector[Metres],
    steps: CallCount,
    callsBeside: Int,
    leftPaused: Boolean,
    images: Vector[CameraSensor.Counts]
):
  def calmFrom: Instant = startedAt + faultPlan.calmFrom

object FlightTrace:
  /** How long the vehicles are watched after the end. */
  val Watched: Span = Span.ofSeconds(4)
