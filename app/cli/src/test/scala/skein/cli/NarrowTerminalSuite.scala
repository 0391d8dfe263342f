package skein.cli

class NarrowTerminalSuite extends munit.FunSuite:

  test("a progress line leaves a terminal's last column free, and shows whether it was cut"):
    val line = " 42 %  3 min left   best 8.31 m with pure-pursuit"
    for columns <- 1 to 80 do
      val shown = ProgressLine.cut(line, Some(columns))
      assert(shown.length < columns, s"$columns columns: '$shown'")
      assert(shown == line || shown.isEmpty || shown.endsWith("…"), s"$columns columns: '$shown'")
    assertEquals(ProgressLine.cut(line, Some(line.length + 1)), line)
    assertEquals(ProgressLine.cut(line, None), line)

  for columns <- Seq(60, 80, 100) do
    test(s"no help text wraps on $columns columns"):
      for command <- Main.commands do
        val widest = command.help(columns).linesIterator.maxBy(_.length)
        assert(widest.length <= columns, s"${command.name}: ${widest.length} columns: '$widest'")
