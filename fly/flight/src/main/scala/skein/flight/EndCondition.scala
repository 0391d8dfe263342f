package skein.flight

import java.util.concurrent.atomic.AtomicReference
import scala.concurrent.{Future, Promise}
import skein.record.*
import skein.scenario.{Known, OwnEnd, Scenario}
import skein.units.*

/** Passes records on to `recorder`, and evaluates at every decision whether the scenario has ended, by the
  * readings that the decision used.
  *
  * @param isPaused whether time stands still during decisions: then ages are zero
  */
private[flight] final class EndCondition(scenario: Scenario, isPaused: Boolean, recorder: Recorder)
    extends Recorder:
  private val end      = OwnEnd.of(scenario)
  private val vehicles = scenario.agents.size
  private val begun    = AtomicReference(Option.empty[Instant])
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
      if isPaused then seen.map(_.copy(age = Span.Zero)) else seen
    )

  def failure: Future[RecordError]                  = recorder.failure
  def close(): Future[Either[RecordError, Written]] = recorder.close()
