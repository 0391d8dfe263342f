package skein.cli

import scala.collection.immutable.ArraySeq
import skein.bytes.Codec
import skein.pickle.Fields
import skein.scenario.{Scenario, Scenarios}
import skein.search.{BlockBytes, JsonText}
import skein.settings.NamedScene
import skein.torture.{Torture, FaultVerdict}
import skein.units.{Expect, Span}
import skein.vehicle.VehicleKind

/** Flights with faults, as workers receive them. A block is a range of seeds.
  *
  * @param scenario the scenario's name; without one, duels
  * @param scene the scene as recorded; None for the scenario's own scene
  */
private[cli] final case class TortureQuestion(
    durationNanos: Long,
    scenario: Option[String],
    scene: Option[Map[String, String]]
) derives Fields:
  def bytes: ArraySeq[Byte] = JsonText.bytes(this)

  /** @return Left says what was expected, what was given, and in which option */
  def ready(using Scenarios): Either[String, TortureQuestion.Ready] =
    for
      task <- Expect.optional(scenario)(TortureQuestion.standard(_))
      _    <- Expect.that(task.forall(_.agents.forall(_.kind == VehicleKind.Multirotor))):
        s"--scenario ${scenario.getOrElse("")}: expected multirotors, " +
          "got cars, whose commands torture does not follow"
      scene <- Expect.optional(scene)(NamedScene.ofRecording(_).left.map("--scene: " + _))
    yield TortureQuestion.Ready(Span.ofNanos(durationNanos), task, scene)

private[cli] object TortureQuestion:

  def of(duration: Span, scenario: Option[String], scene: Option[NamedScene]): TortureQuestion =
    TortureQuestion(
      duration.toNanos,
      scenario,
      scene.map(NamedScene.recorded(_).map(each => each.name -> each.value).toMap)
    )

  private def standard(name: String)(using scenarios: Scenarios): Either[String, Scenario] =
    scenarios.kind(name).map(_.standard).left.map("--scenario: " + _)

  def read(bytes: ArraySeq[Byte])(using Scenarios): Either[String, Ready] =
    JsonText.read[TortureQuestion](bytes, "torture's question").flatMap(_.ready)

  /** @param scenario None for duels, each with the number of vehicles that its seed draws */
  final case class Ready(duration: Span, scenario: Option[Scenario], scene: Option[NamedScene]):

    /** Runs flights in this process, `threads` at a time. */
    def fly(seeds: Iterator[Long], threads: Int)(onVerdict: FaultVerdict => Unit): Unit =
      Torture.all(seeds, duration, threads, scenario, scene)(onVerdict)

    /** The blocks of seeds for other processes, with at most `atMost` seeds each. */
    def blocks(first: Long, seeds: Int, atMost: Int): Vector[ArraySeq[Byte]] =
      Vector.range(0, seeds, atMost).map: from =>
        BlockBytes.of((first + from, atMost.min(seeds - from)))

    /** Runs a block's flights and encodes the broken rules of each seed. */
    def answer(block: ArraySeq[Byte]): ArraySeq[Byte] =
      val (first, count) = told[(Long, Int)](block, "a block of torture")
      val broken         =
        for seed <- Vector.range(first, first + count)
        yield seed -> TortureQuestion.short(Torture.of(seed, duration, scenario, scene).violations)
      BlockBytes.of(broken)

    /** Decodes the verdicts of a block's answer. */
    def verdicts(answer: ArraySeq[Byte]): Vector[FaultVerdict] =
      for (seed, violations) <- told[Vector[(Long, Vector[String])]](answer, "torture's answer")
      yield FaultVerdict(Torture.plan(seed, duration, scenario, scene), violations)

    private def told[A: Codec](bytes: ArraySeq[Byte], what: String): A =
      BlockBytes.read[A](bytes, what).fold(wrong => throw IllegalArgumentException(wrong), identity)

  /** Shortens violations so that a block's answer fits into a message. */
  private def short(violations: Vector[String]): Vector[String] =
    val lines = violations
      .take(MostLines)
      .map(line => if line.length > MostOfLine then line.take(MostOfLine) + "…" else line)
    lines ++ Option.when(violations.size > MostLines)(s"and ${violations.size - MostLines} more")

  private val MostLines, MostOfLine = 200

  /** Maximum number of seeds in one block. */
  val MostSeeds = 8
