package skein.flight

import java.util.concurrent.atomic.AtomicReference
import scala.concurrent.{Future, Promise}
import skein.policy.Seen
import skein.record.*
import skein.scenario.{Known, Scenario}
import skein.signal.{ClockAlignment, Kinematics, Stamped}
import skein.units.*

/** Passes records on to `recorder`, and evaluates at every decision whether the scenario is over. It knows
  * the readings received by then, without overtaken ones.
  *
  * @param isPaused whether time stands still during decisions: then ages are zero
  */
private[flight] final class EndCondition(scenario: Scenario, isPaused: Boolean, recorder: Recorder)
    extends Recorder:
  private val names = scenario.agents.map(_.name)
  private val heard = AtomicReference(EndCondition.Heard(Map.empty, None, None))
  private val over  = Promise[Unit]()

  def isOver: Future[Unit] = over.future

  def offer(record: Recordable): Unit =
    recorder.offer(record)
    record match
      case reading: ReadingRow     => val _ = heard.updateAndGet(_.read(reading.vehicle, reading.state))
      case decision: LaterDecision =>
        val now = heard.updateAndGet(_.begun(decision.decidedAt))
        for
          known <- now.known(names, decision.decidedAt, isPaused)
          if Scenario.told(scenario.name)(scenario.isOver(known))
        do
          val _ = over.trySuccess(())
      case _ => ()

  def failure: Future[RecordError]                  = recorder.failure
  def close(): Future[Either[RecordError, Written]] = recorder.close()

private object EndCondition:

  /** The readings received so far.
    *
    * @param from time of the first decision
    */
  final case class Heard(
      states: Map[String, Stamped[Kinematics]],
      alignment: Option[ClockAlignment],
      from: Option[Instant]
  ):
    def read(vehicle: String, state: Stamped[Kinematics]): Heard =
      val aligned = alignment.fold(ClockAlignment.of(state))(_.updated(state))
      val isNews  = states.get(vehicle).forall(aligned.isNewer(state, _))
      copy(
        states = if isNews then states.updated(vehicle, state) else states,
        alignment = Some(aligned)
      )

    def begun(at: Instant): Heard = if from.isDefined then this else copy(from = Some(at))

    /** The state at a time; absent until every vehicle was read. */
    def known(vehicles: Vector[String], now: Instant, isPaused: Boolean): Option[Known] =
      for
        begin <- from
        seen = vehicles.flatMap(states.get) if seen.size == vehicles.size
      yield Known(
        now.since(begin),
        seen.map: state =>
          val age =
            if isPaused then Span.Zero
            else alignment.flatMap(_.ageOf(state, now)).getOrElse(state.ageByArrival(now))
          Seen(state.value, age, isPredicted = false)
      )
