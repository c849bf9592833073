(* Every statement of the analysed program, and whether Eva reached it: function, file, line, number in its function, reached. *)
let () =
  Db.Main.extend (fun () ->
    if Db.Value.is_computed () then
      Globals.Functions.iter_on_fundecs (fun definition ->
        List.iteri (fun number stmt ->
          let place = fst (Cil_datatype.Stmt.loc stmt) in
          Printf.printf "STATEMENT\t%s\t%s\t%d\t%d\t%b\n"
            definition.Cil_types.svar.Cil_types.vname
            (Filepath.Normalized.to_pretty_string place.Filepath.pos_path)
            place.Filepath.pos_lnum number (Db.Value.is_reachable_stmt stmt))
          (List.sort (fun a b -> compare a.Cil_types.sid b.Cil_types.sid) definition.Cil_types.sallstmts)))
