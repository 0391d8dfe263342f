package skein.formula

import java.lang.constant.ClassDesc
import skein.formula.Value.*

/** The result of a traced method, with access to the fields of the object that it represents. Parts that
  * cannot be read throw [[Untraceable]], with the source line of the result.
  */
final class Answer private[formula] (value: Value, lifter: Lifter):

  /** Calls a method without arguments on the result.
    *
    * @param answers descriptor of the method's return type, as in class files
    */
  def get(method: String, answers: String = "Ljava/lang/Object;"): Answer =
    Answer(lifter.get(value, method, answers), lifter)

  def number: Node = lifter.numberOf(value)

  /** The node of an integer, or of a boolean as 1 or 0. */
  def whole: Node = lifter.wholeOf(value)

  /** Whether the result is this object for all inputs. */
  def isOne(of: AnyRef): Boolean = lifter.isKnown(value, of)

  /** Handles the result by its class. If conditions choose between several classes, the values are combined
    * over them.
    *
    * @param of returns the value for one class, from its name and the result as that class
    * @param or combines the values of two branches
    */
  def fold[A](of: (String, Answer) => A)(or: (Node, A, A) => A): A = lifter.settled(value) match
    case OneOf(condition, yes, no) =>
      or(condition, Answer(yes, lifter).fold(of)(or), Answer(no, lifter).fold(of)(or))
    case one => of(Answer.className(one, lifter), Answer(one, lifter))

  /** The numbers of the result, in the order of [[Example.numbers]]; the result must have the form of the
    * example.
    */
  def numbersOf(example: Example): Vector[Node] =
    val ways           = example.shape.leaves.iterator.map(_.path).toSet
    val found          = Vector.newBuilder[Node]
    def other: Nothing =
      refuse(s"what it remembers is of another form than ${example.name} before the first decision")
    def visit(value: Value, as: AnyRef, at: Path): Unit =
      if ways.contains(at) then
        found += (as match
          case _: java.lang.Double => lifter.numberOf(value)
          case _                   => lifter.wholeOf(value))
      else
        as match
          case null => if lifter.settled(value) != Null then other
          case _: (java.lang.Number | java.lang.Boolean | java.lang.Character | String | Class[?]) =>
            if !lifter.isKnown(value, as) then other
          case _ if as.getClass.isArray =>
            val size = java.lang.reflect.Array.getLength(as)
            if lifter.lengthOf(value) != size then other
            for i <- 0 until size do
              val part = java.lang.reflect.Array.get(as, i)
              visit(lifter.element(value, i), part, Path(Some(at), PathStep.At(i)))
          case _ =>
            val isSame = Answer(value, lifter).fold((of, _) => of == as.getClass.getName)((_, a, b) => a && b)
            if isSame then
              for field <- Shape.fieldsOf(as.getClass) do
                val desc = ClassDesc.ofDescriptor(field.getType.descriptorString)
                visit(
                  lifter.fieldOf(value, field.getName, desc),
                  Shape.read(field, as),
                  Path(Some(at), PathStep.Of(field))
                )
            else if as.getClass.getName.startsWith("scala.Tuple") then
              // A tuple of numbers has a specialised class, and the generic one after a choice by a
              // condition.
              val parts = as.asInstanceOf[Product]
              for i <- 0 until parts.productArity do
                val part = Answer(value, lifter).get(s"_${i + 1}")
                found ++= part.numbersOf(Example(
                  example.name,
                  parts.productElement(i).asInstanceOf[AnyRef],
                  true
                ))
            else other
    visit(value, example.value, example.root)
    found.result()

  def refuse(reason: String): Nothing = lifter.refuse(reason)

private object Answer:
  /** Name of the value's class; a case without fields counts as a class of its own. */
  private def className(value: Value, lifter: Lifter): String = value match
    case Known(single: scala.reflect.Enum, _) if single.productArity == 0 =>
      s"${single.getClass.getSuperclass.getName}$$${single.productPrefix}"
    case other => lifter.classOf(other).fold("nothing")(_.replace('/', '.'))
