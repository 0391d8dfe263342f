package skein.record

/** What a recording holds once closed: rows by table, tables without rows left out. */
final case class Written(rows: Map[String, Long]):
  def total: Long = rows.values.sum

  /** As many rows more as there are names of tables. */
  private[record] def ++(tables: Seq[String]): Written =
    val more = tables.groupMapReduce(identity)(_ => 1)(_ + _)
    Written(more.foldLeft(rows):
      case (rows, (table, count)) => rows.updated(table, rows.getOrElse(table, 0L) + count))

private[skein] object Written:
  val nothing: Written = Written(Map.empty)
