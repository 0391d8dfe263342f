package skein.margin

import skein.scenario.{Limit, Tracks}
import skein.units.Decimals.fixed
import skein.units.Span

/** One run of a program over a link.
  *
  * @param value the run's score
  * @param violations number of violations of the scenario's limits
  * @param callMs median round trip of calls that read states
  * @param ageMs mean age of the vehicle's own data at its commands
  */
final case class MarginRun(
    value: Either[MarginRun.NoResult, Double],
    violations: Int,
    callMs: Option[Double],
    ageMs: Option[Double]
)

object MarginRun:
  /** Why a run does not count: its program failed, or something else did. */
  enum NoResult(val why: String):
    /** The program did nothing that could be scored. */
    case OfProgram(reason: String) extends NoResult(reason)

    /** The machine was too busy, or the run could not start. */
    case OfMachine(reason: String) extends NoResult(reason)

  /** The course of a run, observed from outside.
    *
    * @param exit the program's exit status, if it ended by itself
    * @param commands number of commands to vehicles
    * @param silentFor time from the last message to the end
    * @param lastLine last non-blank line of its standard output; `lastError`: of its standard error
    * @param contacts number of contacts in the scored part
    * @param tracks tracks of the scored part; absent if that is too short
    * @param starved why the machine was too busy, if it was
    */
  final case class Ended(
      exit: Option[Int],
      lasted: Span,
      connections: Int,
      commands: Long,
      silentFor: Span,
      lastLine: Option[String],
      lastError: Option[String],
      contacts: Long,
      tracks: Option[Tracks],
      starved: Option[String]
  )

  /** The value of a run; a failure of the program takes precedence over one of the machine. */
  def judged(by: MarginJudge, ended: Ended): Either[NoResult, Double] =
    died(ended)
      .orElse(hung(by, ended))
      .map(NoResult.OfProgram(_))
      .orElse(ended.starved.map(NoResult.OfMachine(_)))
      .toLeft(())
      .flatMap(_ => value(by, ended).left.map(NoResult.OfProgram(_)))

  /** Violations of limits by a run that has a value. */
  def violations(limits: Vector[Limit], ended: Ended): Int =
    ended.tracks.fold(0)(tracks => limits.map(_.violations(tracks).size).sum)

  private def died(ended: Ended): Option[String] = ended.exit.filter(_ != 0).map: status =>
    s"it ended with exit status $status after ${seconds(ended.lasted)}" +
      ended.lastError.fold("")(line => s": ${line.take(MostOfLine)}")

  private def hung(by: MarginJudge, ended: Ended): Option[String] =
    if ended.connections == 0 then
      Some("it never connected to the port that {port} in its arguments, and SKEIN_PORT, stand for")
    else if by == MarginJudge.Printed then
      Option.when(
        ended.exit.isEmpty
      )(s"it still ran after ${seconds(ended.lasted)}, and had no last line yet")
    else if ended.commands == 0 then Some("it connected, and commanded nothing")
    else
      Option.when(ended.exit.isEmpty && ended.silentFor * 2 > ended.lasted):
        s"it hung: nothing passed in the last ${seconds(ended.silentFor)} of ${seconds(ended.lasted)}"

  private def value(by: MarginJudge, ended: Ended): Either[String, Double] = by match
    case MarginJudge.Printed =>
      val came = ended.lastLine.fold("nothing")(line => s"'${line.take(MostOfLine)}'")
      ended.lastLine
        .flatMap(_.toDoubleOption)
        .filter(_.isFinite)
        .toRight(s"expected a number as the last line that it prints, got $came")
    case MarginJudge.Contacts => ended.tracks.map(_ => ended.contacts.toDouble).toRight(noValue(by, ended))
    case MarginJudge.Flown(measure) => ended.tracks.flatMap(measure.of).toRight(noValue(by, ended))

  private def noValue(by: MarginJudge, ended: Ended) =
    s"it has no value of '${by.name}' after ${seconds(ended.lasted)}"

  private def seconds(span: Span) = s"${span.toSeconds.fixed(1)} s"

  private val MostOfLine = 200
