package skein.loop

/** The position of a part in a graph's drawing.
  *
  * @param column index from the left, from 0
  * @param row index from the top, from 0; halves occur, since columns are centred
  */
final case class Spot(column: Int, row: Double)

/** Lays out a graph in columns: each part is one column after the last of its predecessors, without back
  * edges. Within a column, parts follow the order of their predecessors; back edges are drawn below.
  */
object GraphLayout:

  def of(graph: LoopGraph): Map[String, Spot] =
    val forward = withoutTurns(graph)
    val before  = forward.groupMap(_.to)(_.from).withDefaultValue(Vector.empty)
    val columns = (1 until graph.stages.size).foldLeft(graph.stages.map(_ -> 0).toMap): (columns, _) =>
      forward.foldLeft(columns)((known, edge) =>
        known.updated(edge.to, known(edge.to).max(known(edge.from) + 1))
      )
    val turning   = graph.edges.filterNot(forward.contains).map(_.from).toSet
    val inColumns = graph.stages.groupBy(columns).toVector.sortBy(_._1)
    val tallest   = inColumns.map(_._2.size).maxOption.getOrElse(0)
    inColumns.foldLeft(Map.empty[String, Spot]): (placed, column) =>
      val (at, names)         = column
      def above(name: String) =
        val rows = before(name).flatMap(placed.get).map(_.row)
        rows.sum / rows.size.max(1)
      placed ++ names.sortBy(name => (above(name), turning(name), name)).zipWithIndex.map((name, row) =>
        name -> Spot(at, row + (tallest - names.size) / 2.0)
      )

  /** The edges without back edges (depth-first from the sources). */
  private def withoutTurns(graph: LoopGraph): Vector[(from: String, to: String)] =
    val leads = graph.edges.groupBy(_.from).withDefaultValue(Vector.empty)
    type Found = (closed: Set[String], forward: Vector[(from: String, to: String)])
    def visit(found: Found, name: String, open: Set[String]): Found =
      if found.closed(name) then found
      else
        val passed = leads(name).filterNot(edge => open(edge.to) || edge.to == name).foldLeft(found):
          (found, edge) =>
            val on = visit(found, edge.to, open + name)
            (closed = on.closed, forward = on.forward :+ edge)
        (closed = passed.closed + name, forward = passed.forward)
    val sources = graph.stages.filter(name => graph.edges.forall(_.to != name))
    (sources ++ graph.stages)
      .foldLeft((closed = Set.empty[String], forward = Vector.empty[(from: String, to: String)]))(
        (found, name) =>
          visit(found, name, Set.empty)
      )
      .forward
