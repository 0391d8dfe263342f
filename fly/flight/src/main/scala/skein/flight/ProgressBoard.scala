package skein.flight

import java.io.PrintStream
import me.tongfei.progressbar.{ProgressBar, ProgressBarBuilder, ProgressBarStyle}
import skein.units.*
import skein.units.Decimals.fixed

/** The progress of a flight.
  *
  * @param silentFor time without an answer of the simulator, if it is silent
  * @param flown elapsed time on the controller's clock
  * @param hasEnded whether it has ended, while others still run
  * @param stepped elapsed time on the simulator's clock, if that advances in steps; it then measures the
  *   flight's duration
  */
final case class FlightProgress(
    id: String,
    flown: Span,
    seen: Option[LastSeen],
    silentFor: Option[Span] = None,
    hasEnded: Boolean = false,
    stepped: Option[Span] = None
):
  /** Elapsed part of the flight's duration. */
  def done: Span = stepped.getOrElse(flown)

  def text: String =
    val silence = silentFor.map(span => s"no answer for ${span.toSeconds.fixed(0)} s")
    val shown   = seen.map: seen =>
      seen.distance.fold("")(apart => s"${apart.value.fixed(1, width = 5)} m apart, ") +
        s"${seen.age.toMillis.fixed(0, width = 3)} ms old"
    if hasEnded then "ended" else silence.orElse(shown).getOrElse("")

/** Shows the progress of flights side by side: a bar for each on a terminal, else a line for all every 10 s.
  */
trait ProgressBoard extends AutoCloseable:
  def show(progress: Seq[FlightProgress]): Unit

object ProgressBoard:

  def apply(ids: Seq[String], duration: Span, out: PrintStream): ProgressBoard =
    if System.console() != null && System.console().isTerminal then Bars(ids, duration)
    else Lines(duration, out)

  private final class Bars(ids: Seq[String], duration: Span) extends ProgressBoard:
    private val width                          = ids.map(_.length).maxOption.getOrElse(0)
    private val bars: Map[String, ProgressBar] = ids.map(id => id -> bar(id)).toMap

    def show(progress: Seq[FlightProgress]): Unit =
      for one <- progress do
        val _ = bars(one.id).stepTo(one.done.toSeconds.round).setExtraMessage(one.text)

    def close(): Unit = bars.values.foreach(_.close())

    private def bar(id: String) = ProgressBarBuilder()
      .setTaskName(id.padTo(width, ' '))
      .setInitialMax(duration.toSeconds.ceil.toLong)
      .setUnit(" s", 1)
      .setStyle(ProgressBarStyle.UNICODE_BLOCK)
      .setUpdateIntervalMillis(500)
      .hideEta()
      .build()

  private final class Lines(duration: Span, out: PrintStream) extends ProgressBoard:
    private val every   = Span.ofSeconds(10)
    private var shownAt = Span.Zero

    def show(progress: Seq[FlightProgress]): Unit =
      for furthest <- progress.map(_.flown).maxOption if furthest >= shownAt + every do
        shownAt = furthest
        val flights = progress.map(one => s"${one.id} ${one.text.trim}").mkString("; ")
        // When flights start one after another, the last one still runs after the first has ended.
        val flown = progress.map(_.done).max.min(duration).toSeconds
        out.println(s"${flown.fixed(0)} s of ${duration.toSeconds.fixed(0)} s: $flights")

    def close(): Unit = ()
