//! Chapter 3: perfect contact of two half-spaces, and how well people tell materials apart.

mod answers;
mod finish;
mod materials;

use super::row::Row;

pub(super) fn rows() -> Vec<Row> {
    [
        materials::table_3_1(),
        finish::table_3_2(),
        finish::strains(),
        materials::table_3_4(),
        materials::fourier_claims(),
        answers::table_3_3(),
        answers::ratios(),
        answers::sensitivities(),
        answers::means(),
    ]
    .concat()
}
