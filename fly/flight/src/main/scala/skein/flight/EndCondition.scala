package skein.flight

import java.util.concurrent.atomic.AtomicReference
import scala.concurrent.{Future, Promise}
import skein.policy.Seen
import skein.record.*
import skein.scenario.{Known, OwnEnd, Scenario}
import skein.units.*

/** Passes records on to `recorder`, and evaluates at every decision whether the scenario has ended, by the
  * readings that the decision used.
  *
  * @param isPaused whether time stands still during decisions: then ages are zero
  * @param isDecentralised whether each vehicle has a controller of its own: then the newest reading of each
  *   vehicle counts, by whichever controller
  */
private[flight] final class EndCondition(
    scenario: Scenario,
    isPaused: Boolean,
    isDecentralised: Boolean,
    recorder: Recorder
) extends Recorder:
  private val end      = OwnEnd.of(scenario)
  private val vehicles = scenario.agents.size
  private val begun    = AtomicReference(Option.empty[Instant])
  private val newest   = AtomicReference(Vector.empty[(at: Instant, seen: Seen)])
  private val over     = Promise[Unit]()

  def isOver: Future[Unit] = over.future

  def offer(record: Recordable): Unit =
    recorder.offer(record)
    record match
      case decision: LaterDecision => if end.exists(_(known(decision))) then over.trySuccess(()): Unit
      case _                       => ()

  private def known(decision: LaterDecision) =
    val first = begun.updateAndGet(_.orElse(Some(decision.decidedAt))).get
    val seen  = decision.readings
    require(seen.size == vehicles, s"a decision from readings of ${seen.size} of $vehicles vehicles")
    Known(
      decision.decidedAt.since(first),
      if isPaused then seen.map(_.copy(age = Span.Zero))
      else if isDecentralised then newestWith(seen, decision.decidedAt)
      else seen
    )

  /** The newest readings of all controllers' decisions so far. */
  private def newestWith(seen: Vector[Seen], now: Instant): Vector[Seen] =
    val sampled = seen.map(one => (at = now - one.age, seen = one))
    newest
      .updateAndGet(held =>
        if held.isEmpty then sampled
        else held.zip(sampled).map((before, next) => if next.at > before.at then next else before)
      )
      .map(one => one.seen.copy(age = now.since(one.at).max(Span.Zero)))

  export recorder.{close, failure}
