package skein.mutation

import java.nio.file.{Files, Path}

/** Larger changes than the rules make, which hostile testers once made and no test noticed.
  *
  * @param file
  *   below the repository
  * @param before
  *   occurs once in it
  */
final case class Named(file: String, before: String, after: String):
  def mutant(root: Path): Mutant =
    val path   = root.resolve(file)
    val source = Files.readString(path)
    source.indexOf(before) match
      case at if at >= 0 && source.indexOf(before, at + 1) < 0 =>
        val lines = source.take(at).split("\n", -1)
        Mutant("named", path, lines.length, lines.last.length + 1, at, before, after)
      case _ => sys.error(s"$file: '$before' does not occur once")

object Named:
  private val View      = "flight/src/main/scala/skein/loop/TeamView.scala"
  private val Rows      = "flight/src/main/scala/skein/loop/Rows.scala"
  private val Alignment = "core/src/main/scala/skein/signal/ClockAlignment.scala"

  /** By who should notice: the units' own tests, and whole flights through faults. */
  def all(root: Path): Vector[(Module, Vector[Mutant])] = Vector(
    "units"   -> Vector("skein.signal.*", "skein.loop.*Suite", "skein.measure.*", "skein.report.*") -> units,
    "torture" -> Vector("skein.torture.TortureSimulation")                                          -> torture
  ).map:
    case ((who, suites), named) => (Module(s"named, by $who", "", suites), named.map(_.mutant(root)))

  private val units = Vector(
    Named("flight/src/main/scala/skein/measure/Distribution.scala", "quantile(0.99)", "quantile(0.95)"),
    Named(Rows, "ageOf(opponent.state, now)", "ageOf(own.state, now)"),
    Named(Alignment, "fromSimulator - toSimulator", "toSimulator - fromSimulator"),
    Named(Alignment, "(lower - slack).max(one.lower)", "lower.max(one.lower)"),
    Named(Alignment, "(upper + slack).min(one.upper)", "upper.min(one.upper)"),
    Named(View, ".forall(held => aligned(reading).isNewer(reading.state, held.state))", ".forall(_ => true)")
  )

  /** A wrong sign within the estimate of the offset is held between its bounds, and so to the uncertainty
    * that is told: no flight can tell, but the units can.
    */
  private val torture = Vector(
    Named(View, ".forall(held => aligned(reading).isNewer(reading.state, held.state))", ".forall(_ => true)"),
    Named(
      "flow/src/main/scala/skein/flow/JoinLatest.scala",
      "held.get(key).forall(isNewer(value, _))",
      "true"
    ),
    Named(Rows, "ageOf(opponent.state, now)", "ageOf(own.state, now)"),
    Named(
      "record/src/main/scala/skein/record/MemoryRecorder.scala",
      "else if !closed then",
      "else if !closed && record.hashCode % 50 != 0 then"
    ),
    Named(
      "flight/src/main/scala/skein/torture/FaultyRecorder.scala",
      "else recorder.offer(record)",
      "else ()"
    ),
    Named(Alignment, "simulatorTime + offset", "simulatorTime - offset")
  )
