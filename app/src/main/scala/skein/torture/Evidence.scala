package skein.torture

import skein.loop.Outcome
import skein.record.Recording
import skein.rpc.{RpcSettings, RpcStats}
import skein.units.*

/** What was seen of one flight from outside: enough to judge it.
  *
  * @param crafts
  *   by vehicle
  * @param arrivals
  *   at the simulator, in order, of all vehicles
  * @param mostUnanswered
  *   moves of one vehicle that the simulator had not answered at one time
  * @param mostPending
  *   calls that the client had not ended at one time
  * @param stats
  *   after the client was closed
  * @param drifts
  *   how far each vehicle got within [[Evidence.Watched]], some time after the end
  * @param steps
  *   calls that let the simulator's time run in steps
  * @param signsAskedFor
  *   how often vehicles were asked for a sign of life
  * @param leftPaused
  *   whether the simulator stood still some time after the end
  */
final case class Evidence(
    ordeal: Ordeal,
    window: Int,
    minCommandInterval: Span,
    period: Span,
    startedAt: Instant,
    endedAt: Instant,
    outcome: Outcome,
    vehicles: Vector[String],
    crafts: Vector[WatchedCraft],
    arrivals: Vector[Arrival],
    mostUnanswered: Int,
    mostPending: Long,
    settings: RpcSettings,
    stats: RpcStats,
    recording: Recording,
    drifts: Vector[Metres],
    steps: CallCount,
    signsAskedFor: Int,
    leftPaused: Boolean
):
  def calmFrom: Instant = startedAt + ordeal.calmFrom

object Evidence:
  /** How long the vehicles are watched after the end. */
  val Watched: Span = Span.ofSeconds(4)
