package skein.vehicle

/** Converts states of plants to their components and back, for storage and messages. States are case classes
  * of doubles, or of such case classes; the order is that of their fields.
  */
object PlantState:
  def numbers(state: Any): Vector[Double] = state match
    case number: Double   => Vector(number)
    case several: Product => several.productIterator.flatMap(numbers).toVector
    case _                => Vector.empty

  /** The state with these components, of the form of `like`.
    *
    * @throws IllegalArgumentException if the number of components differs, or the state rejects them
    */
  def of[S](like: S, numbers: Vector[Double]): S =
    val expected = PlantState.numbers(like).size
    require(numbers.size == expected, s"expected a state of $expected numbers, got ${numbers.size}")
    val left                 = numbers.iterator
    def made(part: Any): Any = part match
      case _: Double        => left.next()
      case several: Product =>
        val parts = several.productIterator.map(made).toArray.asInstanceOf[Array[Object]]
        val maker = several.getClass.getDeclaredConstructors
          .find(_.getParameterCount == parts.length)
          .getOrElse(throw IllegalArgumentException(
            s"expected states that are made of their parts alone, of a case class at the top level or in an object, " +
              s"got ${several.getClass.getName}"
          ))
        maker.setAccessible(true)
        maker.newInstance(parts*)
      case other => other
    made(like).asInstanceOf[S]
