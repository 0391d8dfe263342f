package skein.formula

import java.lang.constant.ClassDesc
import skein.formula.Value.*

/** What a traced method has answered: read as the object is that it stands for. What cannot be read is
  * refused with the place where it was answered.
  */
final class Answer private[formula] (value: Value, lifter: Lifter):

  /** What a method without arguments answers.
    *
    * @param answers the type of it, as class files have it
    */
  def get(method: String, answers: String = "Ljava/lang/Object;"): Answer =
    Answer(lifter.get(value, method, answers), lifter)

  /** A number, in an object or not. */
  def number: Node = lifter.numberOf(value)

  /** Whether it is this object, whatever is observed. */
  def isOne(of: AnyRef): Boolean = lifter.isKnown(value, of)

  /** What it is, by the class of it: for each of several between which conditions decide.
    *
    * @param of what it comes to by class and by what is read there
    * @param or makes one of two
    */
  def fold[A](of: (String, Answer) => A)(or: (Node, A, A) => A): A = lifter.settled(value) match
    case OneOf(condition, yes, no) =>
      or(condition, Answer(yes, lifter).fold(of)(or), Answer(no, lifter).fold(of)(or))
    case one => of(Answer.className(one, lifter), Answer(one, lifter))

  /** Its numbers, if it is like an example: in the order of [[Example.numbers]]. */
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
              // A tuple of numbers has a class of its own, and another one where a condition has chosen them.
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
  /** Of a case without fields, as if it had a class of its own. */
  private def className(value: Value, lifter: Lifter): String = value match
    case Known(single: scala.reflect.Enum, _) if single.productArity == 0 =>
      s"${single.getClass.getSuperclass.getName}$$${single.productPrefix}"
    case other => lifter.classOf(other).fold("nothing")(_.replace('/', '.'))
