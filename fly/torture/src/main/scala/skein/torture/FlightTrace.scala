package skein.torture

import skein.flight.CameraSensor
import skein.loop.{FlightOutcome, LoopSettings}
import skein.record.{Record, RecordError, Recording}
import skein.rpc.RpcStats
import skein.units.*

/** External observations of one flight, by which it is checked.
  *
  * @param ports the observed port of each vehicle
  * @param arrivals all vehicles' moves as they arrived at the simulator, in order
  * @param mostUnanswered largest number of simultaneously unanswered moves of one vehicle
  * @param mostPending largest number of simultaneously unfinished calls of the client
  * @param lastHovers when, if ever, the simulator last received a command to hover for a vehicle
  * @param stats the client's statistics after it was closed
  * @param offered records offered to the recorder, in order, while it could keep them
  * @param file the content of the recording's file, or why it cannot be read, if a file was written
  * @param runs the simulator's runs
  * @param drifts drift of each vehicle within [[FlightTrace.Watched]], some time after the end
  * @param steps counts of calls that advance the simulator's time in steps
  * @param callsBeside number of requests for a sign of life
  * @param leftPaused whether the simulator stood still some time after the end
  * @param images each eye's counts of images, after it has ended
  */
final case class FlightTrace(
    faultPlan: FaultPlan,
    settings: LoopSettings,
    startedAt: Instant,
    endedAt: Instant,
    outcome: FlightOutcome,
    ports: Vector[WatchedVehicle],
    arrivals: Vector[ReceivedMove],
    lastHovers: Map[String, Instant],
    mostUnanswered: Int,
    mostPending: Long,
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
  def vehicles: Vector[String] = faultPlan.scenario.agents.map(_.name)

  def calmFrom: Instant = startedAt + faultPlan.calmFrom

object FlightTrace:
  /** Time for which the vehicles are observed after the end. */
  val Watched: Span = Span.ofSeconds(4)
