package skein.flight

import java.nio.file.Path
import skein.loop.{AnyLoop, JointPlanning, Replay}
import skein.measure.RecordedScenario
import skein.record.*
import skein.scenario.Scenarios
import skein.settings.RecordedPlan
import skein.units.Expect

/** The result of replaying a recording.
  *
  * @param decisions number of decisions in the recording
  * @param decidedAgain the first difference when the decisions are repeated on the recorded readings and
  *   moves
  * @param flownAgain the result of repeating the flight with physics and network; only for virtual time, a
  *   loop that the program knows and the built-in simulator
  * @param notFlownAgain why such a flight could not be repeated
  */
final case class Replayed(
    id: String,
    decisions: Int,
    decidedAgain: Option[Difference],
    flownAgain: Option[FlownAgain],
    notFlownAgain: Option[String] = None
):
  def isSame: Boolean = decidedAgain.isEmpty && flownAgain.forall(_.isSame)

/** A repeated flight in virtual time.
  *
  * @param inDecisions the first decision that differs
  */
final case class FlownAgain(recorded: Digest, again: Digest, inDecisions: Option[Difference]):
  def isSame: Boolean = recorded == again

object Replayed:

  /** Replays a recording, live or virtual. Blocks until it is done. */
  def of(file: Path)(using Scenarios): Either[String, Replayed] =
    for
      recording <- RecordingReader.read(file).left.map(_.message)
      _ <- Expect.that(recording.heading.vehicles.nonEmpty)("it has no vehicles, so nothing was decided")
      replayed <- if AnyLoop.parse(recording.flight.loop).isRight then ofKnown(file, recording)
      else ofUnknown(recording)
    yield replayed

  private def ofKnown(file: Path, recording: Recording)(using Scenarios): Either[String, Replayed] =
    for
      flown <- RecordedPlan.of(recording)
      settings = flown.settings.loopSettings(flown.plan)
      _ <- JointPlanning.of(flown.fleet, settings)
      decided = Replay(flown.fleet, recording, settings).firstDifference
      flight  = recording.flight
      link    = Option.when(flight.isVirtual && flight.isBuiltIn)(RecordedPlan.linkOf(recording))
      again <- Expect.each(link.filter(_.isRight))(_ => flyAgain(file, recording, flown))
    yield Replayed(
      flight.id,
      recording.decisions.size,
      decided,
      again.headOption,
      link.flatMap(_.left.toOption)
    )

  /** Replays a flight of an unknown loop: its graph is not on record, so only its decisions are repeated. */
  private def ofUnknown(recording: Recording)(using Scenarios): Either[String, Replayed] =
    for scenario <- RecordedScenario.of(recording)
    yield
      val decided = Replay(scenario.fleet, recording).firstDifference
      Replayed(recording.flight.id, recording.decisions.size, decided, None)

  /** Removes the plans' tracks, which formats up to 5 did not record. */
  private def withoutCourse(record: Record): Record = record match
    case planned: Planned => planned.copy(course = None)
    case other            => other

  private def flyAgain(file: Path, recording: Recording, flown: RecordedPlan): Either[String, FlownAgain] =
    for
      recorded <- Digest.ofFile(file).left.map(_.message)
      landing  <- VirtualFlights.fly(flown.settings, flown.plan)
    yield FlownAgain(
      recorded,
      Digest.of(
        if recording.planned.exists(_.course.isDefined) then landing.recorder.all
        else landing.recorder.all.map(withoutCourse)
      ),
      Difference.first(recording.decisions, landing.recorder.recording.decisions)
    )
