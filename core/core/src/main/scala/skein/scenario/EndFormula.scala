package skein.scenario

import skein.formula.{Example, Formula, Untraceable}
import skein.policy.{InputTags, PolicyInput}

/** A scenario's own end as a formula: [[Scenario.isOver]], read from its bytecode. Its only output is 0 while
  * the flight goes on.
  *
  * @param formula the formula; its parameters are parameters of the scenario
  * @param inputs meaning of each of the formula's inputs; `Elapsed` is the time since the flight's first
  *   decision
  */
private[skein] final class EndFormula(val formula: Formula, val inputs: Vector[PolicyInput])

/** A scenario whose end already is a formula, so that its bytecode is not read. */
private[scenario] trait KnownEnd:
  def end: EndFormula

private[skein] object EndFormula:
  private val Descriptor = "(Lskein/scenario/Known;)Z"

  /** @param vehicles number of the scenario's vehicles
    * @return Left says why the method cannot be traced, with the source line
    */
  def of(end: OwnEnd, vehicles: Int): Either[Untraceable, EndFormula] = end.scenario match
    case known: KnownEnd => Right(known.end)
    case scenario        =>
      val tags    = InputTags()
      val known   = Known(tags.span(PolicyInput.Elapsed), Vector.tabulate(vehicles)(tags.seen(_, false)))
      val example = Example("known", known, refused = InputTags.Refused)
      val loader  = Option(scenario.getClass.getClassLoader).getOrElse(ClassLoader.getSystemClassLoader)
      Formula
        .ofExamples(scenario, "isOver", Descriptor, Seq(example), loader): (_, answer) =>
          (Vector("over" -> answer.whole), ())
        .map((formula, _) => EndFormula(formula, tags.inputs))
