package skein.measure

import skein.record.{LoopKind, Recording}
import skein.units.Decimals.brief
import skein.units.Span

/** Recorded settings that make flights of one scenario, loop and link unlike. */
private[measure] object FlightOptions:
  /** Settings that also change the flight of `paused`. */
  private val OfTruth = Vector("plant", "sensors", "scene", "knows")
  private val OfLoops = Vector("wire", "decentralised", "only", "between", "deadlineNs", "fallback")

  /** Every setting by its recorded name, with its value in words for people. */
  val inWords: Vector[(String, String => String)] =
    def byName(name: String)              = name -> ((value: String) => s"$name $value")
    def flag(name: String, words: String) = name -> ((_: String) => words)
    Vector(
      byName("plant"),
      byName("sensors"),
      byName("scene"),
      byName("knows"),
      byName("wire"),
      flag("decentralised", "decentralised"),
      byName("only"),
      byName("between"),
      "deadlineNs" -> (value =>
        s"deadline ${value.toLongOption.fold(value)(Span.ofNanos(_).toMillis.brief)} ms"
      ),
      byName("fallback"),
      byName("strangers"),
      flag("planInPacket", "plans in packets"),
      byName("planning")
    )

  /** The settings that a flight's loop uses, unless they are the usual ones, by name. */
  def of(recording: Recording): Vector[(String, String)] =
    val used = recording.flight.loopKind match
      case Some(LoopKind.Paused)     => OfTruth
      case Some(LoopKind.Predictive) => OfTruth ++ OfLoops :+ "strangers" :+ "planInPacket"
      case Some(LoopKind.Plan)       => OfTruth ++ OfLoops :+ "planning"
      case _                         => OfTruth ++ OfLoops
    used.flatMap(name => recording.heading.parameter(name).map(name -> valued(recording, name, _)))

  def ofTruth(options: Vector[(String, String)]): Vector[(String, String)] =
    options.filter((name, _) => OfTruth.contains(name))

  /** The value, with a digest of a scene that a file describes. */
  private def valued(recording: Recording, name: String, value: String): String =
    val text = recording.heading.parameter(s"$name.text")
    value + text.fold("")(text => s" (${Integer.toHexString(text.hashCode)})")
